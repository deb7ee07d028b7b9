"""Set-point offsets for load and lag."""

from dataclasses import replace

import numpy as np
import pytest

from walking.feedforward import FeedForward
from walking.joints import HEAD, LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG
from walking.parameters import CONTROL_PERIOD, PatternParameters, StabilizerParameters


def legs(q):
    return tuple(q[LEFT_LEG].tolist()), tuple(q[RIGHT_LEG].tolist())


def feed(robot, **changes):
    parameters = replace(StabilizerParameters(), **changes)
    return FeedForward(robot, parameters, PatternParameters().pelvis_height)


def offsets(robot, zmp=(0.01, 0.0), right_load=0.5, acceleration=(0.0, 0.0)):
    return feed(robot).offsets(robot.ready, legs(robot.ready), zmp, right_load, acceleration)


def test_standing_offsets_mirror(robot):
    offset = offsets(robot)
    signs = np.array([-1, -1, 1, 1, 1, -1])
    np.testing.assert_allclose(offset[RIGHT_LEG], signs * offset[LEFT_LEG], atol=1e-9)
    arms = np.array([1, -1, -1, 1, -1, -1])
    np.testing.assert_allclose(offset[RIGHT_ARM], arms * offset[LEFT_ARM], atol=1e-6)


def test_a_loaded_knee_is_stretched_against_the_weight(robot):
    offset = offsets(robot, zmp=(0.0, 0.035), right_load=0.0)
    assert offset[3] < 0.0 < offset[9]
    assert abs(offset[3]) > 3.0 * abs(offset[9])


def test_the_hip_resists_the_floor_that_pushes_the_body_forward(robot):
    still = offsets(robot, right_load=0.0)
    forward = offsets(robot, right_load=0.0, acceleration=(1.0, 0.0))
    assert forward[2] > still[2]


def test_a_moving_head_is_led_by_its_lag(robot):
    ahead = feed(robot, inertia_gain=0.0)
    q = robot.ready.copy()
    still = ahead.offsets(q, legs(q), (0.01, 0.0), 0.5, (0.0, 0.0))
    moved = q.copy()
    moved[HEAD.start] += 0.01
    after = ahead.offsets(moved, legs(q), (0.01, 0.0), 0.5, (0.0, 0.0))
    rate = 0.01 / CONTROL_PERIOD
    assert after[HEAD.start] - still[HEAD.start] == pytest.approx(
        rate * robot.damping[HEAD.start] / robot.stiffness[HEAD.start], abs=1e-4
    )
