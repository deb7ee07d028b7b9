"""Swing of the foot."""

import numpy as np
import pytest

from walking.foothold import Foothold
from walking.gait.minimum_jerk import PEAK
from walking.gait.swing import min_ticks, moved, resting, stand
from walking.gait.swing_foot_kernel import HEIGHT
from walking.parameters import CONTROL_PERIOD

STANCE = Foothold(True, 0.1, 0.04, 0.2), Foothold(False, 0.1, -0.04, -0.2)


def test_a_foot_that_stands_rests_on_its_foothold_at_the_height_it_has():
    feet = resting(STANCE)
    np.testing.assert_array_equal(feet[:, :3], [[0.1, 0.04, 0.2], [0.1, -0.04, -0.2]])
    assert not feet[:, 3:].any()
    feet[1] = 1.0
    stand(feet[1], STANCE[1])
    assert feet[1].tolist() == [0.1, -0.04, -0.2, 1.0, *6 * [0.0]]
    assert feet[1, HEIGHT] == 1.0


def test_min_ticks_respect_the_peak_speed():
    foot = resting(STANCE)[0]
    ticks = min_ticks(foot, Foothold(True, 0.13, 0.08, 0.0), 0.5)
    assert (ticks - 1) * CONTROL_PERIOD < PEAK * 0.05 / 0.5 <= ticks * CONTROL_PERIOD


def test_a_landing_moves_and_turns_together_and_no_faster_than_allowed():
    a, b = Foothold(True, 0.0, 0.0, 0.0), Foothold(True, 0.03, -0.01, 0.6)
    one = moved(a, b, 0.02, 0.1)
    assert (one.x, one.y, one.yaw) == pytest.approx((0.005, -0.01 / 6.0, 0.1))
    assert moved(a, b, 0.01, 10.0).x == pytest.approx(0.01)
    assert moved(a, b, 0.03, 0.6) is b
