"""Speed control on a body that slips."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.footsteps.speed_hold import SpeedHold
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

PARAMETERS = StabilizerParameters()
CYCLE = 136  # control ticks of two footsteps
slips = st.floats(-0.015, 0.015)


def walk(velocity, slip, *, cycles=25, disturbed=lambda tick: False, hold=None, sway=0.0):
    """Corrections tick by tick of a body on an arc, faster by `slip` than commanded.

    Its heading sways by `sway` [rad] within a cycle.
    """
    hold = hold or SpeedHold(PARAMETERS)
    x = y = 0.0

    def heading(tick):
        return velocity[2] * tick * CONTROL_PERIOD + sway * cos(2.0 * pi * tick / CYCLE)

    result = []
    for tick in range(cycles * CYCLE):
        forward, left = hold.correction(
            (x, y, heading(tick)), velocity, begins=tick % CYCLE == 0, disturbed=disturbed(tick)
        )
        result.append((forward, left))
        middle = 0.5 * (heading(tick) + heading(tick + 1))
        vx, vy = velocity[0] + slip[0] + forward, velocity[1] + slip[1] + left
        x += CONTROL_PERIOD * (cos(middle) * vx - sin(middle) * vy)
        y += CONTROL_PERIOD * (sin(middle) * vx + cos(middle) * vy)
    return result


@given(st.floats(-0.4, 0.4), st.floats(-0.15, 0.15), st.floats(-1.5, 1.5), slips, slips)
def test_a_steady_walk_on_any_arc_gets_its_velocity(vx, vy, wz, ahead, aside):
    result = walk((vx, vy, wz), (ahead, aside))
    assert result[-1] == pytest.approx((-ahead, -aside), abs=1e-4)


@given(st.floats(-0.4, 0.4), st.floats(-1.5, 1.5), st.floats(-0.2, 0.2))
def test_sway_of_the_heading_is_no_error(forward, turn, sway):
    result = walk((forward, 0.0, turn), (0.0, 0.0), cycles=4, sway=sway)
    assert result[-1] == pytest.approx((0.0, 0.0), abs=1e-9)


def test_nothing_is_made_up_for_before_two_footsteps_of_a_steady_walk():
    assert set(walk((0.2, 0.0, 0.0), (0.01, 0.0), cycles=1)) == {(0.0, 0.0)}
    hold = SpeedHold(PARAMETERS)
    walk((0.2, 0.0, 0.0), (0.01, 0.0), hold=hold)
    other = (0.3, 0.0, 0.0)
    assert hold.correction((0.0, 0.0, 0.0), other, begins=False, disturbed=False) == (0.0, 0.0)


def test_footsteps_that_balance_are_not_learned_from():
    assert set(
        walk((0.2, 0.0, 0.0), (0.1, 0.0), disturbed=lambda tick: tick % CYCLE == CYCLE // 2)
    ) == {(0.0, 0.0)}


def test_it_is_limited_and_mirrored():
    one = walk((0.2, 0.05, 0.4), (-0.1, 0.1))
    other = walk((0.2, -0.05, -0.4), (-0.1, -0.1))
    limit = PARAMETERS.max_speed_correction
    assert one[-1] == pytest.approx((limit, -limit))
    assert other == [(x, pytest.approx(-y, abs=1e-12)) for x, y in one]
