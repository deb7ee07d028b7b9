"""Set-point offsets for load and lag."""

import numpy as np
import pytest

from walking.feedforward import FeedForward
from walking.joints import HEAD, LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

PARAMETERS = StabilizerParameters()


def legs(q):
    return tuple(q[LEFT_LEG].tolist()), tuple(q[RIGHT_LEG].tolist())


def test_standing_offsets_mirror(robot):
    q = robot.ready
    offset = FeedForward(robot, PARAMETERS).offsets(q, legs(q), (0.01, 0.0), 0.5)
    signs = np.array([-1, -1, 1, 1, 1, -1])
    np.testing.assert_allclose(offset[RIGHT_LEG], signs * offset[LEFT_LEG], atol=1e-9)
    arms = np.array([1, -1, -1, 1, -1, -1])
    np.testing.assert_allclose(offset[RIGHT_ARM], arms * offset[LEFT_ARM], atol=1e-6)


def test_a_loaded_knee_is_stretched_against_the_weight(robot):
    q = robot.ready
    offset = FeedForward(robot, PARAMETERS).offsets(q, legs(q), (0.0, 0.035), 0.0)
    assert offset[3] < 0.0 < offset[9]
    assert abs(offset[3]) > 3.0 * abs(offset[9])


def test_a_moving_head_is_led_by_its_lag(robot):
    feed = FeedForward(robot, PARAMETERS)
    q = robot.ready.copy()
    still = feed.offsets(q, legs(q), (0.01, 0.0), 0.5)
    moved = q.copy()
    moved[HEAD.start] += 0.01
    lag = feed.offsets(moved, legs(q), (0.01, 0.0), 0.5)[HEAD.start] - still[HEAD.start]
    rate = 0.01 / CONTROL_PERIOD
    assert lag == pytest.approx(rate * robot.damping[HEAD.start] / robot.stiffness[HEAD.start])
