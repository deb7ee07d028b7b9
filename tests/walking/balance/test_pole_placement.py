"""Closed loop of DCM and servo."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from walking.balance.pole_placement import dcm_gain


@given(st.floats(4.0, 12.0), st.floats(1e-3, 0.05), st.floats(0.0, 60.0))
def test_the_closed_loop_has_the_pole_that_was_asked_for_and_none_slower(omega, lag, rate):
    assume(lag * (2.0 * rate + omega) < 0.999)
    gain = dcm_gain(omega, lag, rate)
    poles = np.linalg.eigvals([[omega, -omega], [gain / lag, -1.0 / lag]])
    assert np.abs(poles.imag).max() < 1e-6 / lag
    assert poles.real.max() == pytest.approx(-rate, abs=1e-6 / lag)


def test_without_a_lag_it_is_the_usual_gain():
    assert dcm_gain(7.0, 0.0, 3.5) == pytest.approx(1.5)


def test_a_servo_too_slow_for_the_rate_gets_its_double_pole():
    omega, lag = 7.0, 0.05
    gain = dcm_gain(omega, lag, 10.0)
    poles = np.linalg.eigvals([[omega, -omega], [gain / lag, -1.0 / lag]])
    assert poles == pytest.approx([-6.5, -6.5], abs=1e-5)
