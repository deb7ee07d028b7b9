"""Setpoint offsets for load and lag."""

from dataclasses import replace

import numpy as np
import pytest

from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.parameters import CONTROL_PERIOD, PatternParameters, StabilizerParameters
from walking.servos.feedforward import FeedForward


def feed(robot, **changes):
    parameters = replace(StabilizerParameters(), **changes)
    return FeedForward(robot, parameters, PatternParameters().pelvis_height)


STILL = ((0.0, 0.0), (0.0, 0.0, 0.0))


def legs(robot):
    """Axes and origins of the leg joints in the ready posture."""
    both = [
        leg.joints(robot.ready[part])
        for leg, part in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True)
    ]
    return tuple(np.array(part) for part in zip(*both, strict=True))


PAN = 12
ORIGIN = (0.0, 0.0, 0.0)
SOLES = ((0.01, 0.042), (0.01, -0.042))


def offsets(robot, soles=SOLES, right_load=0.5, acceleration=(0.0, 0.0)):
    return feed(robot).offsets(
        robot.ready, ORIGIN, soles, right_load, acceleration, legs=legs(robot), task=STILL
    )


def test_a_loaded_knee_is_stretched_against_the_weight(robot):
    offset = offsets(robot, right_load=0.0)
    assert offset[3] < 0.0 < offset[9]
    assert abs(offset[3]) > 3.0 * abs(offset[9])


def test_a_moving_head_is_led_by_its_lag(robot):
    ahead = feed(robot, inertia_gain=0.0)
    q = robot.ready.copy()
    still = ahead.offsets(q, ORIGIN, SOLES, 0.5, (0.0, 0.0), legs=legs(robot), task=STILL)
    moved = q.copy()
    moved[PAN] += 0.01
    after = ahead.offsets(moved, ORIGIN, SOLES, 0.5, (0.0, 0.0), legs=legs(robot), task=STILL)
    rate = 0.01 / CONTROL_PERIOD
    assert after[PAN] - still[PAN] == pytest.approx(
        rate * robot.damping[PAN] / robot.stiffness[PAN], abs=1e-4
    )


def test_the_ankle_has_the_moment_of_the_whole_body_about_it(robot):
    """A body that tips sideways in slow motion: at rest over one foot, its mass next to it."""
    compliant = feed(robot, velocity_gain=0.0, inertia_gain=0.0)
    q = robot.ready
    offset = compliant.offsets(q, ORIGIN, SOLES, 0.0, (0.0, 0.0), legs=legs(robot), task=STILL)
    ankle = robot.com(q)[1] - robot.legs[0].pose(q[LEFT_LEG]).y
    weightless = robot.inverse_dynamics(q, 0.0 * q, 0.0 * q, (0.0, 0.0))[0][5]
    moment = offset[5] * robot.stiffness[5] - weightless
    assert moment == pytest.approx(-robot.mass * 9.81 * ankle, rel=0.05)


def test_shared_loads_put_the_zmp_under_either_sole(robot):
    """Moving both soles outward asks nothing more of the ankles: the ZMP is in the middle."""
    narrow = offsets(robot, soles=((0.01, 0.03), (0.01, -0.03)))
    wide = offsets(robot, soles=((0.01, 0.05), (0.01, -0.05)))
    weight = 0.5 * robot.mass * 9.81
    assert (wide - narrow)[5] * robot.stiffness[5] == pytest.approx(-0.02 * weight, rel=0.05)
    assert (wide - narrow)[11] == pytest.approx(-(wide - narrow)[5])


def balanced(robot, right_load, shift, gyro=(0.0, 0.0, 0.0)):
    """Offsets added by the task of the ankles."""
    arguments = (robot.ready, ORIGIN, SOLES, right_load, (0.0, 0.0))
    without = feed(robot).offsets(*arguments, legs=legs(robot), task=STILL)
    return feed(robot).offsets(*arguments, legs=legs(robot), task=(shift, gyro)) - without


def test_ankle_torque_matches_the_shift_of_the_zmp(robot):
    added = balanced(robot, 0.0, (0.02, -0.01))
    weight = robot.mass * 9.81
    # The legs lean by 2 degrees, and their ankle axes with them.
    assert added[4] * robot.stiffness[4] == pytest.approx(weight * 0.02, rel=2e-3)
    assert added[5] * robot.stiffness[5] == pytest.approx(weight * 0.01, rel=2e-3)
    # A foot in the air is left alone, and so is everything else.
    assert not np.delete(added, [4, 5]).any()


def test_the_ankles_share_the_shift_and_damp_the_gyro(robot):
    left = balanced(robot, 0.0, (0.02, -0.01), (0.3, 0.2, 0.1))
    both = balanced(robot, 0.25, (0.02, -0.01), (0.3, 0.2, 0.1))
    np.testing.assert_allclose(both[4:6], 0.75 * left[4:6])
    np.testing.assert_allclose(both[10:12], 0.25 * left[4:6])
    still = balanced(robot, 0.0, (0.02, -0.01))
    gain = StabilizerParameters().gyro_gain
    np.testing.assert_allclose((left - still)[4:6], [gain * 0.2, gain * 0.3], rtol=2e-3)


def test_offsets_are_those_of_the_robot_wherever_it_stands(robot):
    x, y, yaw = 0.7, -0.3, 0.4
    c, s = np.cos(yaw), np.sin(yaw)
    there = tuple((x + c * u - s * v, y + s * u + c * v) for u, v in SOLES)
    turned = [(c * u - s * v, s * u + c * v) for u, v in ((0.2, -0.1), (0.01, 0.02))]
    gyro = (0.3, 0.2, 0.1)
    moved = feed(robot).offsets(
        robot.ready,
        (x, y, yaw),
        there,
        0.3,
        turned[0],
        legs=legs(robot),
        task=(turned[1], gyro),
    )
    here = feed(robot).offsets(
        robot.ready, ORIGIN, SOLES, 0.3, (0.2, -0.1), legs=legs(robot), task=((0.01, 0.02), gyro)
    )
    np.testing.assert_allclose(moved, here, rtol=0.0, atol=1e-12)
