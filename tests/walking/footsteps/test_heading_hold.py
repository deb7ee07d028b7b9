"""Heading control on a body that follows its yaw rate."""

from math import pi, sin

import pytest

from walking.footsteps.heading_hold import HeadingHold
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

PARAMETERS = StabilizerParameters()
CYCLE = 136  # control ticks of two footsteps


def test_a_slip_of_the_body_is_turned_back():
    hold, plan, body = HeadingHold(PARAMETERS), 0.4, 0.3
    hold.reset(plan - body)
    body -= 0.05
    for tick in range(1000):
        turned = hold.rate(plan - body, renew=tick % CYCLE == 0) * CONTROL_PERIOD
        plan, body = plan + turned, body + turned
    assert body == pytest.approx(0.3, abs=1e-3)


def test_a_steady_slip_is_held_although_one_footstep_turns_for_two_and_the_body_sways():
    """The opening foot turns by the rate of that moment for both footsteps."""
    hold, plan, slip, settled = HeadingHold(PARAMETERS), 0.0, 0.0, []
    hold.reset(0.0)
    for tick in range(30 * CYCLE):
        slip -= 0.05 * CONTROL_PERIOD
        phase = tick % CYCLE
        sway = 0.02 * sin(2.0 * pi * phase / CYCLE)
        rate = hold.rate(sway - slip, renew=phase == 0)
        if phase == CYCLE // 4:
            plan += CYCLE * CONTROL_PERIOD * rate
        if phase == CYCLE - 1:
            settled.append(plan + slip)
    assert settled[-1] == pytest.approx(settled[-6], abs=1e-5)


def test_one_rate_serves_a_cycle():
    hold = HeadingHold(PARAMETERS)
    hold.reset(0.0)
    rates = [hold.rate(1e-4 * k, renew=k % CYCLE == 0) for k in range(2 * CYCLE)]
    assert len(set(rates[:CYCLE])) == len(set(rates[CYCLE:])) == 1
    assert rates[0] != rates[-1]


def test_its_rate_is_limited_and_mirrored():
    one, other = HeadingHold(PARAMETERS), HeadingHold(PARAMETERS)
    assert one.rate(2.0, renew=True) == PARAMETERS.max_heading_rate
    assert other.rate(-2.0, renew=True) == -PARAMETERS.max_heading_rate
