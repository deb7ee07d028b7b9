"""Slowdown under large DCM errors."""

from math import exp

import pytest

from walking.footsteps.slowdown import Slowdown
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

PARAMETERS = StabilizerParameters()


def test_errors_of_an_even_floor_slow_nothing():
    caution = Slowdown(PARAMETERS)
    assert {caution.update(PARAMETERS.slowdown_start_error * k / 10) for k in range(11)} == {1.0}


def test_the_speed_ratio_falls_with_the_error_to_its_minimum():
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
