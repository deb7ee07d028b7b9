"""Ankles and capture step."""

from itertools import pairwise
from math import exp

import pytest

from walking.balance.pole_placement import dcm_gain
from walking.balance.stabilizer import Stabilizer
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.parameters import CONTROL_PERIOD, GaitParameters, LimitParameters, StabilizerParameters
from walking.pattern.lipm import Lipm
from walking.pattern.support import support_region

PARAMETERS = StabilizerParameters()
OMEGA = Lipm(0.19).omega
LEFT = Foothold(True, 0.0, 0.042, 0.0)
AHEAD = (0.005, -0.02)  # of the planned DCM from the ZMP [m]


@pytest.fixture
def stabilizer(robot):
    return Stabilizer(robot, PARAMETERS, OMEGA)


@pytest.fixture
def planner(robot):
    return FootstepPlanner(GaitParameters(), LimitParameters(), robot.sole)


def test_the_ankles_push_the_zmp_beyond_the_error_but_not_out_of_the_sole(stabilizer, robot):
    region = support_region(robot.sole, LEFT, LEFT, PARAMETERS.sole_margin)
    dx, dy = stabilizer.zmp_shift((0.01, 0.042), (0.01, 0.005), region)
    gain = dcm_gain(OMEGA, robot.damping[4] / robot.stiffness[4], PARAMETERS.dcm_rate)
    assert gain > 1.0
    assert (dx, dy) == pytest.approx((gain * 0.01, gain * 0.005))
    dx, _ = stabilizer.zmp_shift((0.01, 0.042), (0.5, 0.0), region)
    assert dx == pytest.approx(robot.sole.half_length - PARAMETERS.sole_margin)


def test_small_errors_are_held_and_those_that_are_not_grow_from_nothing(stabilizer, planner):
    landing = planner.landing(LEFT, planner.strides((0.1, 0.0, 0.0), 0.34))
    assert stabilizer.holds(LEFT, (0.005, 0.002))
    assert not stabilizer.holds(LEFT, (0.05, 0.0))
    assert not stabilizer.holds(LEFT, (0.0, -0.05))
    capture = stabilizer.capture(planner, LEFT, landing, (0.005, 0.002), AHEAD, ticks_left=40)
    assert (capture.landing.x, capture.landing.y) == pytest.approx((landing.x, landing.y))
    assert capture.ticks == 40


def test_the_capture_step_goes_where_the_error_will_be(stabilizer, planner, robot):
    landing = planner.landing(LEFT, planner.strides((0.1, 0.0, 0.0), 0.34))
    room = PARAMETERS.capture_dead_zone * (robot.sole.half_length - PARAMETERS.sole_margin)
    capture = stabilizer.capture(planner, LEFT, landing, (room + 0.01, 0.0), AHEAD, ticks_left=30)
    growth = exp(OMEGA * 30 * CONTROL_PERIOD)
    assert capture.landing.x - landing.x == pytest.approx(0.01 * growth)
    assert capture.landing.y == pytest.approx(landing.y)
    assert capture.ticks == 30


def test_a_hopeless_error_still_gives_a_reachable_landing_at_once(stabilizer, planner):
    landing = planner.landing(LEFT, planner.strides((0.0, 0.0, 0.0), 0.34))
    limits = LimitParameters()
    capture = stabilizer.capture(planner, LEFT, landing, (1.0, -1.0), AHEAD, ticks_left=40)
    caught = capture.landing
    assert abs(caught.x - LEFT.x) <= limits.reach_forward + 1e-9
    assert LEFT.y - caught.y <= 2 * GaitParameters().half_stance + limits.reach_side + 1e-9
    assert capture.ticks < 10


def test_a_footstep_is_shortened_only_when_its_landing_is_out_of_reach(stabilizer, planner):
    landing = planner.landing(LEFT, planner.strides((0.0, 0.0, 0.0), 0.34))
    ticks = [
        stabilizer.capture(planner, LEFT, landing, (0.001 * e, 0.0), AHEAD, ticks_left=40).ticks
        for e in range(150)
    ]
    assert ticks[0] == ticks[60] == 40
    assert ticks[-1] < 20
    assert all(later <= sooner for sooner, later in pairwise(ticks))
