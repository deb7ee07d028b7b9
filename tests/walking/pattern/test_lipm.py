"""Closed forms of the pendulum against numerical integration."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from walking.parameters import CONTROL_PERIOD
from walking.pattern.lipm import Lipm

LIPM = Lipm(0.19)


def integrate(x, v, zmp, duration):
    w2 = LIPM.omega**2
    solution = solve_ivp(
        lambda t, s: [s[1], w2 * (s[0] - zmp(t))], (0.0, duration), [x, v], rtol=1e-11, atol=1e-13
    )
    return solution.y[:, -1]


def test_one_tick_under_constant_zmp():
    np.testing.assert_allclose(
        LIPM.step(0.03, -0.2, 0.01),
        integrate(0.03, -0.2, lambda _t: 0.01, CONTROL_PERIOD),
        atol=1e-11,
    )


@pytest.mark.parametrize("ticks", [1, 14, 54])
def test_dcm_under_a_ramp(ticks):
    duration, a, b = ticks * CONTROL_PERIOD, -0.02, 0.05
    x, v = integrate(0.01, 0.15, lambda t: a + (b - a) * t / duration, duration)
    c = LIPM.ramp(ticks)
    after = c.growth * (0.01 + 0.15 / LIPM.omega) - c.first * a - c.last * b
    assert after == pytest.approx(x + v / LIPM.omega, abs=1e-9)


def test_any_time_under_a_constant_zmp():
    np.testing.assert_allclose(
        LIPM.hold(0.03, -0.2, 0.01, 0.0123),
        integrate(0.03, -0.2, lambda _t: 0.01, 0.0123),
        atol=1e-11,
    )
