"""Steady-state Kalman gains of the filter of the CoM error."""

from math import cosh, sinh

import numpy as np
from scipy.linalg import solve_discrete_are

from walking.parameters import CONTROL_PERIOD, EstimatorParameters


def steady_gains(omega: float, parameters: EstimatorParameters) -> tuple[float, float]:
    """Return the gains of position [1] and velocity [1/s] of e'' = ω² (e - d) + noise."""
    dt = CONTROL_PERIOD
    wh = omega * dt
    A = np.array([[cosh(wh), sinh(wh) / omega], [omega * sinh(wh), cosh(wh)]])
    G = np.array([[0.5 * dt * dt], [dt]]) * parameters.acceleration_noise
    C = np.array([[1.0, 0.0]])
    R = np.array([[parameters.position_noise**2]])
    # A little noise on the position itself keeps the Riccati equation well posed.
    Q = G @ G.T + np.diag([1e-12, 0.0])
    P = solve_discrete_are(A.T, C.T, Q, R)
    position, velocity = (P @ C.T / (C @ P @ C.T + R)).ravel().tolist()
    return position, velocity
