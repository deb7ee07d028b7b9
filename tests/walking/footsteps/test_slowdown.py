"""Slower on ground that shakes the robot."""

from math import exp

import pytest

from walking.body.sole import Sole
from walking.command import VelocityCommand
from walking.command_limits import Limit
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.slowdown import Slowdown
from walking.footsteps.steering import Steering
from walking.parameters import CONTROL_PERIOD, StabilizerParameters, WalkingParameters

PARAMETERS = StabilizerParameters()


def test_errors_of_an_even_floor_slow_nothing():
    caution = Slowdown(PARAMETERS)
    assert {caution.update(PARAMETERS.slowdown_start_error * k / 10) for k in range(11)} == {1.0}


def test_the_share_falls_with_the_error_down_to_the_least():
    fractions = [Slowdown(PARAMETERS).update(0.001 * k) for k in range(100)]
    assert fractions == sorted(fractions, reverse=True)
    assert fractions[-1] == pytest.approx(PARAMETERS.min_speed_ratio)


def test_an_error_is_forgotten_with_its_time_constant():
    caution, error = Slowdown(PARAMETERS), 0.03
    caution.update(error)
    for _ in range(round(0.5 / CONTROL_PERIOD)):
        fraction = caution.update(0.0)
    left = error * exp(-0.5 / PARAMETERS.slowdown_time)
    assert fraction == pytest.approx(Slowdown(PARAMETERS).update(left))
    for _ in range(round(5.0 / CONTROL_PERIOD)):
        fraction = caution.update(0.0)
    assert fraction == 1.0


def test_a_cautious_walk_keeps_the_direction_of_the_command_and_says_why():
    parameters = WalkingParameters()
    planner = FootstepPlanner(parameters.gait, parameters.limits, Sole(0.01, 0.0525, 0.03))
    steering = Steering(planner, parameters.limits)
    for _ in range(1000):
        steering.follow(VelocityCommand(0.2, 0.05, 0.3), 0.4, settled=True, balanced=True)
    assert steering.velocity == pytest.approx((0.08, 0.02, 0.12))
    assert steering.bound == (Limit.BALANCE,)
