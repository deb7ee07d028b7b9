"""Steady-state Kalman gains of the filter of the CoM error."""

from dataclasses import dataclass
from math import cosh, sinh

import numpy as np
from scipy.linalg import solve_discrete_are

from walking.parameters import CONTROL_PERIOD, EstimatorParameters


@dataclass(frozen=True, slots=True)
class SteadyGains:
    """Steady-state Kalman gains.

    Attributes:
        position: correction of the position per innovation [1].
        velocity: correction of the velocity per innovation [1/s].
    """

    position: float
    velocity: float


def steady_gains(omega: float, parameters: EstimatorParameters) -> SteadyGains:
    """Return the gains of the filter e'' = ω² (e - d) + noise, e measured in every tick."""
    dt = CONTROL_PERIOD
    wh = omega * dt
    A = np.array([[cosh(wh), sinh(wh) / omega], [omega * sinh(wh), cosh(wh)]])
    G = np.array([[0.5 * dt * dt], [dt]]) * parameters.acceleration_noise
    C = np.array([[1.0, 0.0]])
    R = np.array([[parameters.position_noise**2]])
    # A little noise on the position itself keeps the Riccati equation well posed.
    Q = G @ G.T + np.diag([1e-12, 0.0])
    P = solve_discrete_are(A.T, C.T, Q, R)
    K = (P @ C.T / (C @ P @ C.T + R)).ravel().tolist()
    return SteadyGains(position=K[0], velocity=K[1])
