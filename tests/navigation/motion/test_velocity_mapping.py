import numpy as np
import pytest

from navigation.motion.velocity_mapping import body_velocity, idle_velocity

COURSES = np.linspace(-np.pi, np.pi, 181)


def test_the_direction_is_kept_and_the_envelope_respected(limits):
    v = body_velocity(COURSES, 0.2, 0.3, COURSES, limits=limits, turn_gain=1.5)
    speed = np.hypot(v[:, 0], v[:, 1])
    along = v[:, 0] * np.cos(COURSES - 0.3) + v[:, 1] * np.sin(COURSES - 0.3)
    assert along == pytest.approx(speed)
    assert np.all(speed > 0.05)
    assert v[:, 0].max() <= limits.vx + 1e-12
    assert v[:, 0].min() >= -limits.vx_backward - 1e-12
    assert np.abs(v[:, 1]).max() <= limits.vy + 1e-12
    assert np.abs(v[:, 2]).max() <= limits.wz


def test_inside_the_envelope_nothing_is_lost(limits):
    v = body_velocity(COURSES, 0.07, 0.3, COURSES, limits=limits, turn_gain=1.5)
    assert np.hypot(v[:, 0], v[:, 1]) == pytest.approx(0.07)


def test_it_turns_to_where_it_faces(limits):
    v = body_velocity(1.0, 0.1, 0.0, -0.2, limits=limits, turn_gain=1.5)
    assert v[2] == pytest.approx(-0.3)
    assert body_velocity(0.0, 0.0, 3.0, -3.0, limits=limits, turn_gain=1.5)[2] > 0.0


def test_standing_stands(limits):
    assert body_velocity(1.0, 0.0, 0.0, 0.0, limits=limits, turn_gain=1.5) == pytest.approx(0.0)


def test_an_idle_robot_stands_and_a_lost_one_turns_within_the_limits(limits):
    assert idle_velocity(False, 0.5, limits).tolist() == [0.0, 0.0, 0.0]
    assert idle_velocity(True, 0.5, limits).tolist() == [0.0, 0.0, 0.5]
    assert idle_velocity(True, 9.0, limits).tolist() == [0.0, 0.0, limits.wz]
