"""ZMP functions that lead the pendulum to a walking state."""

from math import exp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.data import Pendulum, Ramp, ZmpFunctions
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import Foothold
from walking.plan.mwpg import (
    admits_target,
    advance_functions,
    reachable_dcm,
    walking_target,
    zmp_function,
)
from walking.plan.pendulum import dcm_of, dcm_reference, natural_frequency
from walking.plan.reference import set_ramp
from walking.plan.support import clip, support_region

W = natural_frequency(0.19)
times = st.floats(0.02, 0.5)
RAMPS = 17


def integrals(function, time):
    """A and B of a two-level function."""
    level, switch = function
    z, growth = exp(W * switch), exp(W * time)
    return level * (growth + 1.0 - 2.0 * z), level * (2.0 / z - 1.0 / growth - 1.0)


@given(times, st.floats(-0.2, 0.2), st.floats(-0.05, 0.05))
def test_the_function_integrates_to_what_is_wanted(time, a, b):
    function = zmp_function(W, time, a, b)
    assert 0.0 <= function[1] <= time + 1e-12
    assert integrals(function, time) == pytest.approx((a, b), abs=1e-7)


@given(times, st.floats(-0.03, 0.03), st.floats(0.0, 1.0), st.floats(-1.0, 1.0))
def test_no_other_two_level_function_has_a_lower_peak(time, first, fraction, ratio):
    """The function is the admissible one wherever any function is."""
    second, growth = first * ratio, exp(W * time)
    z = exp(W * (1.0 - fraction) * time)
    a = first * (growth - z) + second * (z - 1.0)
    b = first * (1.0 / z - 1.0 / growth) + second * (1.0 - 1.0 / z)
    assert abs(zmp_function(W, time, a, b)[0]) <= max(abs(first), abs(second)) + 1e-9


def reference(left, stride=0.05):
    """Straight walk with `left` ticks of the first single support to go."""
    ramps, feet = np.zeros(RAMPS, Ramp), []
    for k in range(9):
        feet.append(Foothold(k % 2 == 0, k * stride, 0.042 * (-1.0) ** k, 0.0))
        place = (feet[k].x + 0.01, feet[k].y)
        set_ramp(ramps[2 * k], left if k == 0 else 54, place, place, feet[k], feet[k])
        if k > 0:
            before = (feet[k - 1].x + 0.01, feet[k - 1].y)
            set_ramp(ramps[2 * k - 1], 14, before, place, feet[k - 1], feet[k])
    return ramps


class Mwpg:
    """Generator and a pendulum in periodic walking at the start of single support."""

    def __init__(self, make_model):
        self.model = make_model("mwpg")
        robot, ramps = self.model.robot, reference(54)
        self.plan, self.pendulum = np.zeros(1, ZmpFunctions)[0], np.zeros(1, Pendulum)[0]
        growth = exp(W * 54 * CONTROL_PERIOD)
        # Under a ZMP at rest ζ only decays.
        zeta = [growth * z for z in walking_target(ramps, robot).zeta]
        x, y = dcm_reference(ramps, robot)
        dx, dy, p = x - 0.01, y - 0.042, self.pendulum
        p.x, p.y = 0.01 + 0.5 * (dx + zeta[0]), 0.042 + 0.5 * (dy + zeta[1])
        p.vx, p.vy = 0.5 * W * (dx - zeta[0]), 0.5 * W * (dy - zeta[1])
        foot = Foothold(True, 0.0, 0.042, 0.0)
        self.region = support_region(robot.support, foot, foot, 0.005)

    def tick(self, ramps):
        """Whether the reference is admitted, and the ZMP."""
        robot, p = self.model.robot, self.pendulum
        trial = self.plan.copy()
        admitted = admits_target(trial, p, ramps, self.region, robot)
        advance_functions(self.plan, p, ramps, self.region, robot)
        zmp = (float(p.zmp_x), float(p.zmp_y))
        assert clip(self.region, *zmp) == pytest.approx(zmp, abs=1e-12)
        return admitted, *zmp


@pytest.fixture
def mwpg(make_model):
    return Mwpg(make_model)


def test_a_walk_that_goes_on_unchanged_needs_no_function(mwpg):
    path = [mwpg.tick(reference(54 - k)) for k in range(54)]
    assert all(row[0] for row in path)
    zmp = np.array([row[1:] for row in path])
    np.testing.assert_allclose(zmp, np.tile([0.01, 0.042], (54, 1)), atol=1e-4)


@pytest.mark.parametrize("tick", [0, 10, 25])
@pytest.mark.parametrize("stride", [0.035, 0.065])
def test_position_and_velocity_of_a_new_walk_are_reached_at_touchdown(mwpg, tick, stride):
    path = [mwpg.tick(reference(54 - k, 0.05 if k < tick else stride)) for k in range(54)]
    assert all(row[0] for row in path)
    target, p = walking_target(reference(1, stride), mwpg.model.robot), mwpg.pendulum
    dx, dy = p.x - 0.01, p.y - 0.042
    assert (dx + p.vx / W, dy + p.vy / W) == pytest.approx(target.xi, abs=1e-5)
    assert (dx - p.vx / W, dy - p.vy / W) == pytest.approx(target.zeta, abs=1e-5)


def test_a_late_change_is_rejected(mwpg):
    path = [mwpg.tick(reference(54 - k, 0.05 if k < 48 else 0.12)) for k in range(54)]
    assert [row[0] for row in path[:49]] == 48 * [True] + [False]


def test_the_part_of_the_dcm_that_is_out_of_reach_is_reported(mwpg):
    mwpg.pendulum.vx += 0.4
    mwpg.tick(reference(54))
    robot = mwpg.model.robot
    reached = reachable_dcm(mwpg.plan, mwpg.pendulum, robot)
    assert reached[0] < dcm_of(mwpg.pendulum, robot)[0] - 0.005
