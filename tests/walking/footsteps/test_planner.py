"""Velocity to footholds."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.body.sole import Sole
from walking.command import CommandState
from walking.command_limits import Limit
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.parameters import GaitParameters, LimitParameters

GAIT, LIMITS = GaitParameters(), LimitParameters()
SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
PLANNER = FootstepPlanner(GAIT, LIMITS, SOLE)
LEFT = Foothold(True, 0.0, GAIT.half_stance, 0.0)
velocities = st.tuples(
    st.floats(-LIMITS.vx_backward, LIMITS.vx),
    st.floats(-LIMITS.vy, LIMITS.vy),
    st.floats(-LIMITS.wz, LIMITS.wz),
)
yaws = st.floats(-pi, pi)


def seen_from(support, step):
    c, s = cos(support.yaw), sin(support.yaw)
    dx, dy = step.x - support.x, step.y - support.y
    return c * dx + s * dy, c * dy - s * dx, step.yaw - support.yaw


def landed(support, velocity):
    return PLANNER.landing(support, PLANNER.strides(velocity, GAIT.footstep_time))


@given(velocities, yaws)
def test_footholds_turn_and_move_with_the_support_foot(velocity, yaw):
    support = Foothold(True, 1.0, -2.0, yaw)
    assert seen_from(support, landed(support, velocity)) == pytest.approx(
        seen_from(LEFT, landed(LEFT, velocity)), abs=1e-9
    )


@given(velocities, st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))
def test_every_corner_of_a_landing_clears_the_support_foot(velocity, dx, dy):
    landing = PLANNER.reachable(LEFT, landed(LEFT, velocity), dx, dy)
    _, y, yaw = seen_from(LEFT, landing)
    for u in (SOLE.centre - SOLE.half_length, SOLE.centre + SOLE.half_length):
        for v in (-SOLE.half_width, SOLE.half_width):
            corner = y + sin(yaw) * u + cos(yaw) * v
            assert corner <= -(SOLE.half_width + GAIT.foot_clearance) + 1e-9


def test_the_foot_on_the_side_of_the_motion_opens():
    assert PLANNER.opening_left((0.1, 0.05, 0.0)) is True
    assert PLANNER.opening_left((0.1, 0.0, -0.5)) is False
    assert PLANNER.opening_left((0.1, 0.0, 0.0)) is None


@given(velocities)
def test_a_walk_is_quickened_before_its_footsteps_are_cut(velocity):
    timing = PLANNER.cadence(velocity)
    assert GAIT.min_footstep_time - 0.005 < timing.duration <= GAIT.footstep_time
    quickest = timing.duration == pytest.approx(GAIT.min_footstep_time)
    cut = set(PLANNER.stride_limits(velocity, timing.duration - 0.0025)) - {Limit.CLEARANCE}
    assert quickest or not cut


@given(velocities)
def test_strides_make_the_velocity_unless_a_limit_says_otherwise(velocity):
    time = PLANNER.cadence(velocity).duration
    made = PLANNER.velocity(PLANNER.strides(velocity, time), time)
    assert made == pytest.approx(velocity, abs=1e-9) or PLANNER.stride_limits(velocity, time)


def test_a_turn_that_must_keep_the_feet_apart_is_no_turn_on_the_spot():
    time = PLANNER.cadence((0.0, 0.0, 1.5)).duration
    assert PLANNER.stride_limits((0.0, 0.0, 1.5), time) == [Limit.CLEARANCE]
    _, left, turn = PLANNER.velocity(PLANNER.strides((0.0, 0.0, 1.5), time), time)
    assert left > 0.01
    assert turn == pytest.approx(1.5)


def test_a_slow_walk_keeps_the_usual_time():
    for velocity in ((0.2, 0.0, 0.0), (-0.1, 0.08, 0.0), (0.2, 0.0, 0.8)):
        assert PLANNER.cadence(velocity).duration == pytest.approx(GAIT.footstep_time)


@pytest.mark.parametrize("time", [1e-9, 0.008, 0.34])
@pytest.mark.parametrize("fraction", [1e-9, 0.5, 1.0 - 1e-9])
def test_the_shortest_footstep_has_a_tick_of_either_support(time, fraction):
    gait = GaitParameters(footstep_time=time, min_footstep_time=time, double_support=fraction)
    timing = FootstepPlanner(gait, LIMITS, SOLE).cadence((0.1, 0.0, 0.0))
    assert timing.double >= 1
    assert timing.single >= 1


@pytest.mark.parametrize("forward", [-0.05, 0.1])
@pytest.mark.parametrize("direction", [-0.1, 0.0, 0.1])
def test_strides_and_timing_are_read_back_as_the_command_state(forward, direction):
    command = CommandState(0.3, 0.1, forward, 0.13, direction, 0.02)
    strides, bound = PLANNER.explicit(command, 0.0)
    timing, late = PLANNER.timing(command)
    assert not bound
    assert not late
    read = PLANNER.command_state(strides, timing)
    for name in ("single_support", "double_support", "forward", "side", "direction"):
        assert getattr(read, name) == pytest.approx(getattr(command, name))
