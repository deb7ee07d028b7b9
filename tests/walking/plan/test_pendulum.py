"""Closed forms of the pendulum against numerical integration, and tracking of the DCM."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from walking.data import Pendulum, Ramp
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import Foothold
from walking.plan.pendulum import (
    dcm_of,
    dcm_reference,
    hold,
    hold_tick,
    ramp_weights,
    track_dcm,
    track_reference,
)
from walking.plan.support import support_region
from walking.plane import clamp, dead_zone

RAMPS = np.zeros(3, Ramp)
RAMPS["ticks"] = 20, 54, 14
RAMPS["ax"], RAMPS["bx"] = (0.0, 0.01, 0.01), (0.01, 0.01, 0.05)
RAMPS["ay"], RAMPS["by"] = (0.0, 0.03, 0.03), (0.03, 0.03, -0.03)
VALUE, LIMIT = st.floats(-10.0, 10.0), st.floats(0.0, 5.0)


@given(VALUE, LIMIT)
def test_a_clamped_value_and_its_excess_add_up(value, limit):
    assert (clamp(value, limit) == value) == (abs(value) <= limit)
    assert clamp(-value, limit) == -clamp(value, limit)
    assert clamp(value, limit) + dead_zone(value, limit) == pytest.approx(value, abs=1e-12)


@pytest.fixture(scope="module")
def omega(model):
    return float(model.robot.omega)


@pytest.fixture(scope="module")
def both(model):
    feet = Foothold(False, 0.0, -0.042, 0.0), Foothold(True, 0.0, 0.042, 0.0)
    return support_region(model.robot.support, *feet, 0.005)


def pendulum(x, y, vx=0.0, vy=0.0):
    record = np.zeros(1, Pendulum)[0]
    record.x, record.y, record.vx, record.vy = x, y, vx, vy
    return record


def integrate(omega, x, v, zmp, duration):
    solution = solve_ivp(
        lambda t, s: [s[1], omega**2 * (s[0] - zmp(t))],
        (0.0, duration),
        [x, v],
        rtol=1e-11,
        atol=1e-13,
    )
    return solution.y[:, -1]


@pytest.mark.parametrize("time", [CONTROL_PERIOD, 0.0123])
def test_a_time_under_a_constant_zmp(model, omega, time):
    expected = integrate(omega, 0.03, -0.2, lambda _t: 0.01, time)
    np.testing.assert_allclose(hold(omega, 0.03, -0.2, 0.01, time), expected, atol=1e-11)
    if time == CONTROL_PERIOD:
        tick = hold_tick(model.robot, 0.03, -0.2, 0.01)
        np.testing.assert_allclose(tick, expected, atol=1e-11)


@pytest.mark.parametrize("ticks", [1, 14, 54])
def test_the_dcm_under_a_ramp(omega, ticks):
    duration, a, b = ticks * CONTROL_PERIOD, -0.02, 0.05
    x, v = integrate(omega, 0.01, 0.15, lambda t: a + (b - a) * t / duration, duration)
    growth, first, last = ramp_weights(omega * CONTROL_PERIOD, ticks)
    after = growth * (0.01 + 0.15 / omega) - first * a - last * b
    assert after == pytest.approx(x + v / omega, abs=1e-9)


def test_from_the_dcm_of_a_reference_it_is_walked_exactly(model, omega):
    x, y = dcm_reference(RAMPS, model.robot)
    for ramp in RAMPS:
        growth, first, last = ramp_weights(omega * CONTROL_PERIOD, ramp.ticks)
        x = growth * x - first * ramp.ax - last * ramp.bx
        y = growth * y - first * ramp.ay - last * ramp.by
    assert (x, y) == pytest.approx((RAMPS[-1].bx, RAMPS[-1].by), abs=1e-9)


def test_a_pendulum_on_the_dcm_is_walked_along_the_reference(model, both):
    state = pendulum(*dcm_reference(RAMPS, model.robot))
    track_reference(state, model.robot, 2.0, RAMPS, both)
    left, first = RAMPS.copy(), RAMPS[0]
    # Held for a tick, the ZMP is that of the tick's middle.
    assert state.zmp_x == pytest.approx(0.5 / first.ticks * first.bx)
    left[0].ticks -= 1
    left[0].ax, left[0].ay = first.bx / first.ticks, first.by / first.ticks
    due = dcm_reference(left, model.robot)
    assert dcm_of(state, model.robot) == pytest.approx(due, abs=1e-6)


@pytest.mark.parametrize("gain", [1.5, 3.0])
def test_an_error_of_the_dcm_shrinks_by_the_gain(model, omega, both, gain):
    state = pendulum(0.012, -0.001, -0.001 * omega, 0.002 * omega)  # its DCM is off by 1 mm
    track_dcm(state, model.robot, gain, (0.01, 0.0), (0.01, 0.0), both)
    growth = ramp_weights(omega * CONTROL_PERIOD, 1)[0]
    left = growth - gain * (growth - 1.0)
    x, y = dcm_of(state, model.robot)
    assert (x - 0.01, y) == pytest.approx((0.001 * left, 0.001 * left))
