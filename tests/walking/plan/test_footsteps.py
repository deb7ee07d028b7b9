"""Velocities and command states to strides, timing and footholds."""

from dataclasses import asdict
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.command import CLEARANCE, CommandState
from walking.constants import parameters_record
from walking.data import StepCommand, Timing
from walking.model import Strides
from walking.parameters import CONTROL_PERIOD, GaitParameters, LimitParameters, WalkingParameters
from walking.plan.footsteps import (
    Foothold,
    clear_of,
    command_of,
    command_strides,
    landing_of,
    mean_velocity,
    reachable,
    velocity_strides,
)
from walking.plan.timing import cadence, command_timing, put_timing

GAIT, LIMITS = GaitParameters(), LimitParameters()
LEFT = Foothold(True, 0.0, GAIT.half_stance, 0.0)
PARAMETERS = parameters_record(WalkingParameters())[0]
velocities = st.tuples(
    st.floats(-LIMITS.vx_backward, LIMITS.vx),
    st.floats(-LIMITS.vy, LIMITS.vy),
    st.floats(-LIMITS.wz, LIMITS.wz),
)


def seen_from(support, step):
    c, s = cos(support.yaw), sin(support.yaw)
    dx, dy = step.x - support.x, step.y - support.y
    return c * dx + s * dy, c * dy - s * dx, step.yaw - support.yaw


def time_of(timing):
    return (timing[0] + timing[1]) * CONTROL_PERIOD


def limits_of(model, velocity, time):
    scratch = np.zeros(1, Strides)[0]
    return velocity_strides(scratch, velocity, time, model.robot)


@given(velocities, st.floats(-pi, pi))
def test_footholds_turn_and_move_with_the_support_foot(strides_of, velocity, yaw):
    support, strides = Foothold(True, 1.0, -2.0, yaw), strides_of(velocity)
    assert seen_from(support, landing_of(support, strides)) == pytest.approx(
        seen_from(LEFT, landing_of(LEFT, strides)), abs=1e-9
    )


@given(velocities, st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))
def test_every_corner_of_a_landing_clears_the_support_foot(
    robot, model, strides_of, velocity, dx, dy
):
    landing = landing_of(LEFT, strides_of(velocity))
    shifted = reachable(LEFT, landing, dx, dy, model.robot)
    _, y, yaw = seen_from(LEFT, shifted)
    sole = robot.sole
    for u in (sole.centre - sole.half_length, sole.centre + sole.half_length):
        for v in (-sole.half_width, sole.half_width):
            corner = y + sin(yaw) * u + cos(yaw) * v
            assert corner <= -(sole.half_width + GAIT.foot_clearance) + 1e-9


@given(st.floats(-0.2, 0.2), st.floats(-0.5, 0.5), st.sampled_from((-1.0, 1.0)))
def test_a_clear_landing_moves_no_further_than_needed(robot, model, y, turned, side):
    sole, gap = robot.sole, 0.012
    result = clear_of(y, turned, side, gap, model.robot.sole)
    inner = min(
        side * (result + sin(turned) * u + cos(turned) * v)
        for u in (sole.centre - sole.half_length, sole.centre + sole.half_length)
        for v in (-sole.half_width, sole.half_width)
    )
    assert inner >= sole.half_width + gap - 1e-12
    assert result == y or inner == pytest.approx(sole.half_width + gap, abs=1e-12)


@given(velocities)
def test_a_mirrored_velocity_swaps_the_strides(strides_of, velocity):
    vx, vy, wz = velocity
    one, other = strides_of(velocity), strides_of((vx, -vy, -wz))
    for a, b in ((one.right, other.left), (one.left, other.right)):
        assert (a.x, a.y, a.yaw) == pytest.approx((b.x, -b.y, -b.yaw), abs=1e-15)


@given(velocities)
def test_a_walk_is_quickened_before_its_footsteps_are_cut(model, velocity):
    time = time_of(cadence(velocity, PARAMETERS))
    assert GAIT.min_footstep_time - 0.005 < time <= GAIT.footstep_time
    quickest = time == pytest.approx(GAIT.min_footstep_time)
    assert quickest or not limits_of(model, velocity, time - 0.0025) & ~CLEARANCE


@given(velocities)
def test_strides_make_the_velocity_unless_a_limit_binds(model, strides_of, velocity):
    time = time_of(cadence(velocity, PARAMETERS))
    made = mean_velocity(strides_of(velocity, time), time, PARAMETERS)
    assert made == pytest.approx(velocity, abs=1e-9) or limits_of(model, velocity, time)


def test_a_turn_that_must_keep_the_feet_apart_also_moves_sideways(model, strides_of):
    turn = (0.0, 0.0, 1.5)
    time = time_of(cadence(turn, PARAMETERS))
    assert limits_of(model, turn, time) == CLEARANCE
    _, left, rate = mean_velocity(strides_of(turn, time), time, PARAMETERS)
    assert left > 0.01
    assert rate == pytest.approx(1.5)


@pytest.mark.parametrize("forward", [-0.05, 0.1])
@pytest.mark.parametrize("direction", [-0.1, 0.0, 0.1])
def test_strides_and_timing_are_read_back_as_the_command_state(model, forward, direction):
    command = np.zeros(1, StepCommand)[0]
    for name, value in asdict(CommandState(0.3, 0.1, forward, 0.13, direction, 0.02)).items():
        command[name] = value
    strides, timing = np.zeros(1, Strides)[0], np.zeros(1, Timing)[0]
    assert command_strides(strides, command, 0.0, model.robot) == 0
    ticks, late = command_timing(command, PARAMETERS)
    put_timing(timing, ticks)
    assert late == 0
    assert command_of(strides, timing) == pytest.approx(command.item())
