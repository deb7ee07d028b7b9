"""Steering: commands to strides, and the report of limits."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.body.sole import Sole
from walking.command import VelocityCommand
from walking.command_limits import Limit
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.steering import STRIDE_LIMITS, Steering
from walking.footsteps.stride import STILL
from walking.footsteps.velocity import limited
from walking.parameters import CONTROL_PERIOD, WalkingParameters

PARAMETERS = WalkingParameters()
LIMITS = PARAMETERS.limits
PLANNER = FootstepPlanner(PARAMETERS.gait, LIMITS, Sole(0.01, 0.0525, 0.03))
LONG = 250  # control ticks in which any velocity is reached
commands = st.builds(
    VelocityCommand, st.floats(-0.7, 0.7), st.floats(-0.3, 0.3), st.floats(-2.5, 2.5)
)
walks = st.lists(st.tuples(commands | st.just(VelocityCommand()), st.integers(1, 30)), max_size=4)
either = st.booleans()


def steer(*, selective=False):
    return Steering(PLANNER, LIMITS, selective=selective)


def follow(steering, command, *, ticks=1, fraction=1.0):
    for _ in range(ticks):
        steering.follow(command, fraction, settled=True, balanced=True)


@given(st.floats(-0.2, 0.2), st.floats(-0.05, 0.05), st.floats(-0.3, 0.3), either)
def test_a_command_within_the_limits_is_followed_exactly(vx, vy, wz, selective):
    steering = steer(selective=selective)
    follow(steering, VelocityCommand(vx, vy, wz), ticks=LONG)
    assert steering.velocity == (vx, vy, wz)
    assert set(steering.bound) <= STRIDE_LIMITS
    wish, time = steering.strides(STILL), steering.timing.duration
    assert wish == PLANNER.strides((vx, vy, wz), time)
    if not steering.bound:
        assert PLANNER.velocity(wish, time) == pytest.approx((vx, vy, wz), abs=1e-9)


@given(walks, either)
def test_a_command_is_reported_as_limited_if_and_only_if_it_is(walk, selective):
    steering = steer(selective=selective)
    for command, ticks in walk:
        for _ in range(ticks):
            follow(steering, command)
            bound = set(steering.bound) - STRIDE_LIMITS
            error = max(
                abs(a - b) for a, b in zip(steering.velocity, command.velocity, strict=True)
            )
            at_rest = command != VelocityCommand() or steering.velocity == STILL
            assert bool(bound) is (error > 1e-9 or not at_rest)
            report = steering.report([], steering.velocity, None, steering.timing)
            assert report.limited is bool(steering.bound)
            if not STRIDE_LIMITS.isdisjoint(steering.bound):
                continue
            assert report.applied.velocity == pytest.approx(steering.velocity, abs=1e-9)


@given(walks)
def test_the_velocity_rises_no_faster_than_the_legs_can(walk):
    steering = steer(selective=True)
    most = (LIMITS.forward_acceleration, LIMITS.lateral_acceleration, LIMITS.turn_acceleration)
    for command, ticks in walk:
        for _ in range(ticks):
            before = steering.velocity
            follow(steering, command)
            assert (
                limited(VelocityCommand(*steering.velocity), LIMITS)
                == pytest.approx(steering.velocity)
                or Limit.ACCELERATION in steering.bound
            )
            for old, new, rate in zip(before, steering.velocity, most, strict=True):
                assert abs(new) - abs(old) <= rate * CONTROL_PERIOD + 1e-12


@given(commands, either)
def test_to_stand_is_obeyed_at_once_where_the_pattern_selects_and_in_the_braking_time_else(
    command, selective
):
    steering = steer(selective=selective)
    follow(steering, command, ticks=LONG)
    moving = steering.moving
    follow(steering, VelocityCommand())
    if selective:
        assert not steering.moving
        assert steering.bound == ()
    elif moving:
        assert steering.moving is (Limit.ACCELERATION in steering.bound)
    follow(steering, VelocityCommand(), ticks=round(LIMITS.braking_time / CONTROL_PERIOD))
    assert not steering.moving


def test_a_slowed_walk_keeps_the_direction_of_the_command():
    steering = steer()
    follow(steering, VelocityCommand(0.2, 0.05, 0.3), ticks=1000, fraction=0.4)
    assert steering.velocity == pytest.approx((0.08, 0.02, 0.12))
    assert steering.bound == (Limit.BALANCE,)


def test_footsteps_that_close_the_stance_keep_the_time_of_the_walk():
    steering = steer(selective=True)
    follow(steering, VelocityCommand(LIMITS.vx), ticks=LONG)
    quick = steering.timing
    assert steering.next_timing(PLANNER.cadence(STILL), stepping=True) == quick
    follow(steering, VelocityCommand())
    usual = PLANNER.cadence(STILL)
    assert quick.duration < usual.duration
    assert steering.next_timing(quick, stepping=True) == quick
    assert steering.next_timing(quick, stepping=False) == usual
