"""Tilt and centre-of-mass error from noisy sensors."""

import numpy as np
import pytest

from walking.estimator import ErrorFilter, TiltFilter, TouchDown, steady_gains
from walking.lipm import Lipm
from walking.parameters import CONTROL_PERIOD, EstimatorParameters

PARAMETERS = EstimatorParameters()
LIPM = Lipm(0.19)
OMEGA = LIPM.omega


def test_tilt_settles_on_the_imu_and_starts_there():
    tilt = TiltFilter(PARAMETERS)
    tilt.update(0.1, -0.05, [0.0, 0.0, 0.0])
    assert (tilt.roll, tilt.pitch) == (0.1, -0.05)
    for _ in range(400):
        tilt.update(0.02, 0.03, [0.0, 0.0, 0.0])
    assert (tilt.roll, tilt.pitch) == pytest.approx((0.02, 0.03), abs=1e-4)


def test_tilt_of_a_trunk_that_yaws_under_a_constant_lean():
    # A lean fixed in the world becomes roll, then pitch, as the body turns under it.
    rate, lean, ticks = 3.0, 0.1, 300
    tilt = TiltFilter(EstimatorParameters(tilt_gain=1e-9))
    for _ in range(ticks):
        tilt.update(lean, 0.0, [0.0, 0.0, rate])
    angle = rate * (ticks - 1) * CONTROL_PERIOD
    expected = (lean * np.cos(angle), -lean * np.sin(angle))
    assert (tilt.roll, tilt.pitch) == pytest.approx(expected, abs=0.01)


def test_tilt_noise_is_reduced():
    rng = np.random.default_rng(0)
    tilt = TiltFilter(PARAMETERS)
    rows = []
    for _ in range(4000):
        roll, pitch = rng.normal(0.0, 0.0025, 2).tolist()
        tilt.update(roll, pitch, rng.normal(0.0, 0.01, 3).tolist())
        rows.append((tilt.roll, tilt.pitch))
    assert np.std(rows[200:]) < 0.0006


def test_the_error_filter_finds_a_diverging_body():
    error = ErrorFilter(OMEGA, PARAMETERS)
    rng = np.random.default_rng(1)
    for k in range(60):
        truth = 0.002 * np.exp(OMEGA * k * CONTROL_PERIOD)
        noisy = truth + rng.normal(0.0, PARAMETERS.position_noise)
        error.update((float(noisy), 0.0), (0.0, 0.0), (0.0, 0.0))
    assert error.vx == pytest.approx(OMEGA * truth, rel=0.2)
    assert (error.y, error.vy) == (0.0, 0.0)


def test_a_jump_of_the_plan_is_no_velocity():
    error = ErrorFilter(OMEGA, PARAMETERS)
    error.shift(0.02, -0.01)
    error.update((0.02, -0.01), (0.02, -0.01), (0.0, 0.0))
    assert (error.x, error.y) == pytest.approx((0.02, -0.01))
    assert abs(error.vx) < 1e-9


def test_slip_of_the_foot_becomes_velocity_of_the_body():
    error = ErrorFilter(OMEGA, PARAMETERS)
    for _ in range(400):
        error.update((0.0, 0.0), (0.0, 0.0), (0.05, 0.0))
    assert error.vx == pytest.approx(0.05, rel=0.05)


def test_touch_down_needs_the_phase_the_force_and_the_duration():
    touch = TouchDown(PARAMETERS)
    assert not touch.update(0.3, 50.0)
    assert not touch.update(0.7, 50.0)
    assert touch.update(0.72, 50.0)
    assert not touch.update(0.74, 1.0)
    assert not touch.update(0.76, 50.0)


def test_rates_of_a_trunk_that_does_not_yaw_are_integrated():
    tilt = TiltFilter(EstimatorParameters(tilt_gain=1e-12))
    tilt.update(0.05, -0.02, [9.0, 9.0, 9.0])  # the first only says where it is
    for _ in range(100):
        tilt.update(0.0, 0.0, [0.1, -0.3, 0.0])
    time = 100 * CONTROL_PERIOD
    assert (tilt.roll, tilt.pitch) == pytest.approx((0.05 + 0.1 * time, -0.02 - 0.3 * time))


def test_the_steady_gains_are_where_the_filter_settles():
    dt, p = CONTROL_PERIOD, PARAMETERS
    A = np.array([LIPM.step(1.0, 0.0, 0.0), LIPM.step(0.0, 1.0, 0.0)]).T
    noise = np.array([0.5 * dt * dt, dt]) * p.acceleration_noise
    P, K = np.eye(2), np.zeros(2)
    for _ in range(5000):
        P = A @ P @ A.T + np.outer(noise, noise)
        K = P[:, 0] / (P[0, 0] + p.position_noise**2)
        P = P - np.outer(K, P[0])
    gains = steady_gains(OMEGA, p)
    assert (gains.position, gains.velocity) == pytest.approx(K.tolist(), rel=0.01)


def test_both_axes_are_filtered_alike():
    rng = np.random.default_rng(2)
    one, other = ErrorFilter(OMEGA, PARAMETERS), ErrorFilter(OMEGA, PARAMETERS)
    for _ in range(50):
        inputs = rng.normal(0.0, 0.01, (3, 2)).tolist()
        one.update(*map(tuple, inputs))
        other.update(*(pair[::-1] for pair in inputs))
        assert (one.x, one.vx, one.y, one.vy) == (other.y, other.vy, other.x, other.vx)


def test_what_is_measured_as_predicted_moves_as_the_pendulum():
    """Over one tick, to the third order of time."""
    error = ErrorFilter(OMEGA, PARAMETERS)
    gains = steady_gains(OMEGA, PARAMETERS)
    error.x, error.vx = 0.01, -0.05
    x, v = LIPM.step(0.01, -0.05, 0.004)
    error.update((x, 0.0), (0.004, 0.0), (0.0, 0.0))
    assert error.x == pytest.approx(x, abs=1e-7)
    assert error.vx == pytest.approx(v, abs=1e-4)
    error.update((error.x + 1.0, 0.0), (error.x, 0.0), (error.vx, 0.0))
    assert error.x == pytest.approx(x + gains.position, abs=1e-4)
    assert error.vx == pytest.approx(v + gains.velocity, abs=1e-3)
