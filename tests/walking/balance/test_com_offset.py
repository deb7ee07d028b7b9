"""CoM offset of a body whose centre of mass differs from the model."""

from itertools import pairwise
from math import pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.balance.com_offset import ComOffset
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

PARAMETERS = StabilizerParameters()
CYCLE = 136  # control ticks of two footsteps
offs = st.floats(-0.012, 0.012)


def walk(off, *, cycles=30, sway=0.02, disturbed=lambda tick: False):
    """Offsets tick by tick; the centre of pressure sways about the mass centre."""
    hold, result = ComOffset(PARAMETERS), []
    for tick in range(cycles * CYCLE):
        swayed = sway * sin(2.0 * pi * tick / CYCLE)
        error = off[0] + hold.offset[0] + swayed, off[1] + hold.offset[1] - swayed
        hold.update(error, begins=tick % CYCLE == 0, disturbed=disturbed(tick))
        result.append(hold.offset)
    return result


@given(offs, offs)
def test_the_centre_of_pressure_comes_under_the_plan(ahead, aside):
    assert walk((ahead, aside))[-1] == pytest.approx((-ahead, -aside), abs=2e-4)


def test_a_sway_within_the_cycle_is_left_alone():
    assert max(abs(v) for offset in walk((0.0, 0.0)) for v in offset) < 1e-9


def test_it_moves_slowly_and_not_too_far():
    result = walk((-0.1, 0.1))
    assert result[-1] == pytest.approx((PARAMETERS.max_com_offset, -PARAMETERS.max_com_offset))
    fastest = max(abs(b[0] - a[0]) for a, b in pairwise(result))
    assert fastest <= PARAMETERS.max_com_offset_rate * CONTROL_PERIOD + 1e-12


def test_footsteps_that_balance_are_not_learned_from():
    result = walk((0.01, 0.0), disturbed=lambda tick: tick % CYCLE == 7)
    assert set(result) == {(0.0, 0.0)}


def test_the_offset_outlasts_a_rest():
    hold = ComOffset(PARAMETERS)
    for tick in range(4 * CYCLE):
        hold.update((0.01, 0.0), begins=tick % CYCLE == 0, disturbed=False)
    before = hold.offset
    assert before[0] < 0.0
    hold.reset()
    hold.update((-0.3, 0.0), begins=False, disturbed=False)
    assert hold.offset[0] <= before[0]
