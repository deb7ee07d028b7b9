"""Attitude, complementary filter and error filter."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.body import estimation_kernel
from walking.body.steady_gains import steady_gains
from walking.parameters import CONTROL_PERIOD, EstimatorParameters
from walking.pattern.lipm import Lipm

PARAMETERS = EstimatorParameters()
LIPM = Lipm(0.19)
GAINS = steady_gains(LIPM.omega, PARAMETERS)
FILTER = np.array([*GAINS, LIPM.omega])
SEEDS = st.integers(0, 10**6)


class Tilt:
    """Roll and pitch of a trunk."""

    def __init__(self, gain=PARAMETERS.tilt_gain):
        self.gain, self.state = gain, np.zeros(3)

    def update(self, roll, pitch, gyro):
        estimation_kernel.follow_tilt(
            self.state, roll, pitch, np.array(gyro), self.gain, CONTROL_PERIOD
        )
        return self.state[1:].tolist()


def follow(error, measured, zmp_shift=(0.0, 0.0), slip=(0.0, 0.0)):
    estimation_kernel.filter_error(error, measured, zmp_shift, slip, FILTER, CONTROL_PERIOD)


def quaternion(roll, pitch, yaw):
    cr, sr = cos(0.5 * roll), sin(0.5 * roll)
    cp, sp = cos(0.5 * pitch), sin(0.5 * pitch)
    cy, sy = cos(0.5 * yaw), sin(0.5 * yaw)
    return (
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    )


@given(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0))
def test_an_attitude_there_and_back(roll, pitch, yaw):
    result = estimation_kernel.roll_pitch_yaw(quaternion(roll, pitch, yaw))
    assert result == pytest.approx((roll, pitch, yaw), abs=1e-6)


def test_both_signs_of_a_quaternion_mean_the_same():
    q = quaternion(0.1, -0.2, 2.0)
    result = estimation_kernel.roll_pitch_yaw(tuple(-v for v in q))
    assert result == pytest.approx(estimation_kernel.roll_pitch_yaw(q))


def test_straight_up_pitch_is_a_right_angle():
    upright = estimation_kernel.roll_pitch_yaw(quaternion(0.0, 0.5 * pi, 0.0))
    assert upright[1] == pytest.approx(0.5 * pi)


def test_tilt_settles_on_the_imu_and_starts_there():
    tilt = Tilt()
    assert tilt.update(0.1, -0.05, [0.0, 0.0, 0.0]) == [0.1, -0.05]
    for _ in range(400):
        result = tilt.update(0.02, 0.03, [0.0, 0.0, 0.0])
    assert result == pytest.approx((0.02, 0.03), abs=1e-4)


def test_tilt_of_a_trunk_that_yaws_under_a_constant_lean():
    # A lean fixed in the world becomes roll, then pitch, as the body turns under it.
    rate, lean, ticks = 3.0, 0.1, 300
    tilt = Tilt(1e-9)
    for _ in range(ticks):
        result = tilt.update(lean, 0.0, [0.0, 0.0, rate])
    angle = rate * (ticks - 1) * CONTROL_PERIOD
    assert result == pytest.approx((lean * np.cos(angle), -lean * np.sin(angle)), abs=0.01)


def test_rates_of_a_trunk_that_does_not_yaw_are_integrated():
    tilt = Tilt(1e-12)
    tilt.update(0.05, -0.02, [9.0, 9.0, 9.0])  # initializes the filter
    for _ in range(100):
        result = tilt.update(0.0, 0.0, [0.1, -0.3, 0.0])
    time = 100 * CONTROL_PERIOD
    assert result == pytest.approx((0.05 + 0.1 * time, -0.02 - 0.3 * time))


def test_the_error_filter_finds_a_diverging_body():
    error, rng = np.zeros(5), np.random.default_rng(1)
    for k in range(60):
        truth = 0.002 * np.exp(LIPM.omega * k * CONTROL_PERIOD)
        noisy = truth + rng.normal(0.0, PARAMETERS.position_noise)
        follow(error, (float(noisy), 0.0))
    assert error[2] == pytest.approx(LIPM.omega * truth, rel=0.2)
    assert (error[1], error[3]) == (0.0, 0.0)


def test_an_error_held_by_the_ankles_is_no_velocity():
    error = np.array([0.02, -0.01, 0.0, 0.0, -1.0])
    follow(error, (0.02, -0.01), (0.02, -0.01))
    assert error[:2] == pytest.approx((0.02, -0.01))
    assert abs(error[2]) < 1e-9


def test_slip_of_the_foot_becomes_velocity_of_the_body():
    error = np.zeros(5)
    for _ in range(400):
        follow(error, (0.0, 0.0), slip=(0.05, 0.0))
    assert error[2] == pytest.approx(0.05, rel=0.05)


def test_the_error_filter_predicts_with_the_pendulum():
    """Over one tick, to the third order of time."""
    error = np.array([0.01, 0.0, -0.05, 0.0, -1.0])
    x, v = LIPM.step(0.01, -0.05, 0.004)
    follow(error, (x, 0.0), (0.004, 0.0))
    assert error[0] == pytest.approx(x, abs=1e-7)
    assert error[2] == pytest.approx(v, abs=1e-4)
    follow(error, (error[0] + 1.0, 0.0), (error[0], 0.0), (error[2], 0.0))
    assert error[0] == pytest.approx(x + GAINS[0], abs=1e-4)
    assert error[2] == pytest.approx(v + GAINS[1], abs=1e-3)


@given(SEEDS)
def test_a_level_point_keeps_its_distance(seed):
    point = tuple(np.random.default_rng(seed).normal(0.0, 0.1, 3).tolist())
    levelled = estimation_kernel.level(point, (0.2, -0.3))
    assert np.linalg.norm(levelled) == pytest.approx(np.linalg.norm(point))


@pytest.mark.parametrize(("pad", "x", "y"), [(0, 1, 1), (1, 1, -1), (2, -1, 1), (3, -1, -1)])
def test_the_centre_of_pressure_is_at_the_loaded_corner(pad, x, y):
    corner = (9.0, 0.01 + 0.05 * x, 0.03 * y)
    assert estimation_kernel.load_of(9.0 * np.eye(4)[pad], (0.01, 0.05, 0.03)) == pytest.approx(
        corner
    )


def test_both_axes_are_filtered_alike():
    rng = np.random.default_rng(2)
    one, other = np.zeros(5), np.zeros(5)
    for _ in range(50):
        inputs = rng.normal(0.0, 0.01, (3, 2)).tolist()
        follow(one, *map(tuple, inputs))
        follow(other, *(tuple(pair[::-1]) for pair in inputs))
        assert (one[[0, 2, 1, 3]] == other[[1, 3, 0, 2]]).all()


@given(SEEDS)
def test_a_body_on_its_plan_has_no_error_in_any_frame(seed):
    rng = np.random.default_rng(seed)
    x, y, yaw, turn = rng.uniform(-0.5, 0.5, 4).tolist()
    arm = rng.uniform(-0.1, 0.1, 2).tolist()
    c, s = cos(turn), sin(turn)
    planned = (x + c * arm[0] - s * arm[1], y + s * arm[0] + c * arm[1])
    com = (0.3 + arm[0], -0.2 + arm[1])
    error = estimation_kernel.com_error(com, (0.3, -0.2, yaw), (x, y, yaw + turn, 0.0), planned)
    assert error == pytest.approx((0.0, 0.0, planned[0] - x, planned[1] - y), abs=1e-12)
