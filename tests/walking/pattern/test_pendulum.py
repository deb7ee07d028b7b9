"""One tick of the pendulum."""

from dataclasses import replace

import pytest

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.support import support_region

LIPM = Lipm(0.19)
FOOT = Foothold(True, 0.1, 0.04, 0.2)
REGION = support_region(Sole(0.0, 0.05, 0.03), FOOT, FOOT, 0.005)


def test_a_pendulum_at_rest_above_its_zmp_stays():
    state = PendulumState(0.1, 0.04)
    state.step(LIPM, (0.1, 0.04), REGION)
    assert state == PendulumState(0.1, 0.04, 0.0, 0.0, 0.1, 0.04)


def test_the_zmp_stays_in_the_region_and_drives_the_pendulum_away():
    state = PendulumState(0.1, 0.04)
    state.step(LIPM, (0.5, 0.04), REGION)
    assert (state.zmp_x, state.zmp_y) == REGION.clip(0.5, 0.04)
    assert state.vx < 0.0


def test_motion_is_relative():
    one = PendulumState(0.1, 0.04, 0.2, -0.1)
    other = replace(one, x=one.x + 0.01)
    one.step(LIPM, (0.1, 0.04), REGION)
    other.step(LIPM, (0.11, 0.04), REGION)
    assert (other.x, other.vx) == pytest.approx((one.x + 0.01, one.vx))
