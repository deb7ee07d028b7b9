"""Steady-state Kalman gains of the error filter."""

import numpy as np
import pytest

from walking.body.steady_gains import steady_gains
from walking.parameters import CONTROL_PERIOD, EstimatorParameters
from walking.pattern.lipm import Lipm

PARAMETERS = EstimatorParameters()
LIPM = Lipm(0.19)
OMEGA = LIPM.omega


def test_the_steady_gains_are_where_the_filter_settles():
    dt, p = CONTROL_PERIOD, PARAMETERS
    A = np.array([LIPM.step(1.0, 0.0, 0.0), LIPM.step(0.0, 1.0, 0.0)]).T
    noise = np.array([0.5 * dt * dt, dt]) * p.acceleration_noise
    P, K = np.eye(2), np.zeros(2)
    for _ in range(5000):
        P = A @ P @ A.T + np.outer(noise, noise)
        K = P[:, 0] / (P[0, 0] + p.position_noise**2)
        P = P - np.outer(K, P[0])
    assert steady_gains(OMEGA, p) == pytest.approx(K.tolist(), rel=0.01)
