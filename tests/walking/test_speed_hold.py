"""The speed hold on a body that slips as it walks."""

from math import cos, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.parameters import CONTROL_PERIOD, StabilizerParameters
from walking.speed_hold import SpeedHold

PARAMETERS = StabilizerParameters()
CYCLE = 136  # control ticks of two footsteps
slips = st.floats(-0.015, 0.015)


def walk(velocity, slip, *, cycles=25, disturbed=lambda tick: False, hold=None):
    """Corrections tick by tick of a body on an arc, faster by `slip` than it is told."""
    hold = hold or SpeedHold(PARAMETERS)
    x = y = yaw = 0.0
    found = []
    for tick in range(cycles * CYCLE):
        forward, left = hold.correction(
            (x, y, yaw), velocity, begins=tick % CYCLE == 0, disturbed=disturbed(tick)
        )
        found.append((forward, left))
        middle = yaw + 0.5 * velocity[2] * CONTROL_PERIOD
        vx, vy = velocity[0] + slip[0] + forward, velocity[1] + slip[1] + left
        x += CONTROL_PERIOD * (cos(middle) * vx - sin(middle) * vy)
        y += CONTROL_PERIOD * (sin(middle) * vx + cos(middle) * vy)
        yaw += velocity[2] * CONTROL_PERIOD
    return found


@given(st.floats(-0.4, 0.4), st.floats(-0.15, 0.15), st.floats(-1.5, 1.5), slips, slips)
def test_a_steady_walk_on_any_arc_gets_its_velocity(forward, left, turn, ahead, aside):
    found = walk((forward, left, turn), (ahead, aside))
    assert found[-1] == pytest.approx((-ahead, -aside), abs=1e-4)


def test_nothing_is_made_up_for_before_two_footsteps_of_a_steady_walk():
    assert set(walk((0.2, 0.0, 0.0), (0.01, 0.0), cycles=1)) == {(0.0, 0.0)}
    hold = SpeedHold(PARAMETERS)
    walk((0.2, 0.0, 0.0), (0.01, 0.0), hold=hold)
    assert hold.correction((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), begins=False, disturbed=False) == (
        0.0,
        0.0,
    )


def test_footsteps_that_balance_are_not_learned_from():
    assert set(
        walk((0.2, 0.0, 0.0), (0.1, 0.0), disturbed=lambda tick: tick % CYCLE == CYCLE // 2)
    ) == {(0.0, 0.0)}


def test_it_is_limited_and_mirrored():
    one = walk((0.2, 0.05, 0.4), (-0.1, 0.1))
    other = walk((0.2, -0.05, -0.4), (-0.1, -0.1))
    limit = PARAMETERS.speed_correction
    assert one[-1] == pytest.approx((limit, -limit))
    assert other == [(x, pytest.approx(-y, abs=1e-12)) for x, y in one]
