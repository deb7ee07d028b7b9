"""Ankles and capture step."""

from math import exp

import pytest

from walking.footsteps import FootstepPlanner
from walking.lipm import Lipm
from walking.parameters import CONTROL_PERIOD, GaitParameters, LimitParameters, StabilizerParameters
from walking.stabilizer import Stabilizer
from walking.state import Footstep
from walking.support import support_region

PARAMETERS = StabilizerParameters()
OMEGA = Lipm(0.19).omega
LEFT = Footstep(True, 0.0, 0.042, 0.0)
STILL = [0.0, 0.0, 0.0]


@pytest.fixture
def stabilizer(robot):
    return Stabilizer(robot, PARAMETERS, OMEGA)


@pytest.fixture
def planner(robot):
    return FootstepPlanner(GaitParameters(), LimitParameters(), robot.sole)


def test_the_ankles_push_the_zmp_beyond_the_error_but_not_out_of_the_sole(stabilizer, robot):
    region = support_region(robot.sole, LEFT, LEFT, PARAMETERS.sole_margin)
    dx, dy = stabilizer.zmp_shift((0.01, 0.042), (0.01, 0.005), region)
    assert (dx, dy) == pytest.approx((PARAMETERS.dcm_gain * 0.01, PARAMETERS.dcm_gain * 0.005))
    dx, _ = stabilizer.zmp_shift((0.01, 0.042), (0.5, 0.0), region)
    assert dx == pytest.approx(robot.sole.half_length - PARAMETERS.sole_margin)


def test_ankle_torque_matches_the_shift(stabilizer, robot):
    ankle = stabilizer.ankles(LEFT, 1.0, (0.02, -0.01), STILL)
    weight = robot.mass * 9.81
    assert ankle.pitch * robot.stiffness[4] == pytest.approx(weight * 0.02)
    assert ankle.roll * robot.stiffness[5] == pytest.approx(weight * 0.01)


def test_a_foot_in_the_air_is_left_alone(stabilizer):
    ankle = stabilizer.ankles(LEFT, 0.0, (0.02, 0.01), [1.0, 1.0, 1.0])
    assert (ankle.pitch, ankle.roll) == (0.0, 0.0)


def test_small_errors_move_no_foothold(stabilizer, planner):
    landing = planner.landing(LEFT, planner.strides((0.1, 0.0, 0.0), 0.34))
    assert stabilizer.capture(planner, LEFT, landing, (0.005, 0.002), 40) is landing


def test_the_capture_step_goes_where_the_error_will_be(stabilizer, planner, robot):
    landing = planner.landing(LEFT, planner.strides((0.1, 0.0, 0.0), 0.34))
    room = PARAMETERS.capture_dead_zone * (robot.sole.half_length - PARAMETERS.sole_margin)
    caught = stabilizer.capture(planner, LEFT, landing, (room + 0.01, 0.0), 30)
    growth = exp(OMEGA * 30 * CONTROL_PERIOD)
    assert caught.x - landing.x == pytest.approx(0.01 * growth)
    assert caught.y == pytest.approx(landing.y)


def test_a_hopeless_error_still_gives_a_reachable_landing(stabilizer, planner):
    landing = planner.landing(LEFT, planner.strides((0.0, 0.0, 0.0), 0.34))
    limits = LimitParameters()
    caught = stabilizer.capture(planner, LEFT, landing, (1.0, -1.0), 40)
    assert abs(caught.x - LEFT.x) <= limits.reach_forward + 1e-9
    assert LEFT.y - caught.y <= 2 * GaitParameters().half_stance + limits.reach_side + 1e-9
