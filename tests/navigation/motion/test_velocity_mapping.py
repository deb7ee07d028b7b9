import numpy as np
import pytest

from navigation.motion.velocity_mapping import (
    arriving,
    body_velocity,
    target_heading,
    towards,
)
from navigation.parameters.navigation import NavigationParameters

COURSES = np.linspace(-np.pi, np.pi, 181)


@pytest.fixture
def mapped(limits):
    def mapped(course, speed, heading, facing):
        return body_velocity(course, speed, heading, facing, limits=limits, turn_gain=1.5)

    return mapped


def test_the_direction_is_kept_and_the_limits_respected(limits, mapped):
    v = np.array([mapped(c, 0.2, 0.3, c) for c in COURSES.tolist()])
    speed = np.hypot(v[:, 0], v[:, 1])
    along = v[:, 0] * np.cos(COURSES - 0.3) + v[:, 1] * np.sin(COURSES - 0.3)
    assert along == pytest.approx(speed)
    assert np.all(speed > 0.05)
    assert v[:, 0].max() <= limits.vx + 1e-12
    assert v[:, 0].min() >= -limits.vx_backward - 1e-12
    assert np.abs(v[:, 1]).max() <= limits.vy + 1e-12
    assert np.abs(v[:, 2]).max() <= limits.wz


def test_the_body_turns_to_its_target_heading(mapped):
    assert mapped(1.0, 0.1, 0.0, -0.2)[2] == pytest.approx(-0.3)
    assert mapped(0.0, 0.0, 3.0, -3.0)[2] > 0.0


@pytest.mark.parametrize("course", [-2.0, 0.0, 0.7])
def test_the_body_faces_its_course_unless_it_looks_or_arrives(task, course):
    p, far, goal = NavigationParameters(), np.array([5.0, 0.0]), task((0.0, 0.0), is_goal=True)
    assert target_heading(far, goal, None, course, p) is None
    assert target_heading(far, goal, 0.5, course, p) == towards(0.5, course, p.gaze.max_pan)
    assert target_heading(np.zeros(2), goal, 0.5, course, p) == goal.heading


def test_the_body_turns_to_the_heading_near_the_goal_only(task):
    for ratio in (0.9, 1.1):
        point = np.array([ratio * 0.4, 0.0])
        goal, via = (task((0.0, 0.0), is_goal=end) for end in (True, False))
        assert arriving(point, goal, 0.4) == (ratio < 1.0)
        assert not arriving(point, via, 0.4)
        assert arriving(point, task((0.0, 0.0), is_goal=True, aligning=True), 0.0)


@pytest.mark.parametrize("course", [-3.0, 0.2, 3.1])
@pytest.mark.parametrize("offset", [-2.0, -0.3, 0.0, 0.5, 3.0])
def test_a_body_turns_to_a_direction_but_no_further_from_its_course(course, offset):
    heading = towards(course + offset, course, 1.0)
    assert heading - course == pytest.approx(np.clip(offset, -1.0, 1.0))
