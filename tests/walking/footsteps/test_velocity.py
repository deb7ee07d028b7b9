"""Limits and slew of the velocity."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.command import VelocityCommand
from walking.footsteps.velocity import VelocitySlew, limited
from walking.parameters import CONTROL_PERIOD, LimitParameters

LIMITS = LimitParameters()
speeds = st.floats(-2.0, 2.0)


@given(speeds, speeds, speeds)
def test_limited_velocity_is_within_every_limit(vx, vy, wz):
    f, s, t = limited(VelocityCommand(vx, vy, wz), LIMITS)
    assert -LIMITS.vx_backward <= f <= LIMITS.vx
    assert abs(s) <= LIMITS.vy
    assert abs(t) <= LIMITS.wz
    ahead = LIMITS.vx if f >= 0.0 else LIMITS.vx_backward
    norm = (f / ahead) ** 2 + (s / LIMITS.vy) ** 2 + (t / LIMITS.wz) ** 2
    assert norm <= LIMITS.combined**2 + 1e-9


@given(speeds, speeds, speeds)
def test_limits_are_idempotent_and_mirror(vx, vy, wz):
    once = limited(VelocityCommand(vx, vy, wz), LIMITS)
    assert limited(VelocityCommand(*once), LIMITS) == pytest.approx(once)
    mirrored = limited(VelocityCommand(vx, -vy, -wz), LIMITS)
    assert mirrored == pytest.approx((once[0], -once[1], -once[2]))


@pytest.mark.parametrize("wanted", [0.0, 0.1, -0.3])
def test_a_walk_is_braked_in_the_braking_time_and_reverses_through_rest(wanted):
    slew = VelocitySlew(LIMITS)
    slew.start((LIMITS.vx, 0.0, 0.0))
    speeds = [slew.velocity[0]]
    while slew.velocity[0] > max(wanted, 0.0):
        slew.follow(VelocityCommand(wanted))
        speeds.append(slew.velocity[0])
    assert speeds[-1] == max(wanted, 0.0)
    assert len(speeds) * CONTROL_PERIOD <= LIMITS.braking_time + 2.0 * CONTROL_PERIOD
    slew.follow(VelocityCommand(wanted))
    assert (
        abs(slew.velocity[0] - speeds[-1]) <= LIMITS.forward_acceleration * CONTROL_PERIOD + 1e-12
    )
