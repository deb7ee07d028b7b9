"""Compiled part of the obstacle set: standard deviations of positions and velocities."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]


@compiled
def deviation(xx: float, xy: float, yy: float) -> float:
    """Return the square root of the larger eigenvalue of a symmetric matrix (2, 2)."""
    half = 0.5 * (xx - yy)
    return sqrt(max(0.5 * (xx + yy) + sqrt(half * half + xy * xy), 0.0))


@compiled
def deviations(covariances: Array) -> tuple[Array, Array]:
    """Return the major standard deviations of positions and velocities (n,), (n,) [m, m/s].

    Args:
        covariances: of (x, y, vx, vy) (n, 4, 4).
    """
    n = len(covariances)
    positions, velocities = np.empty(n), np.empty(n)
    for i in range(n):
        P = covariances[i]
        positions[i] = deviation(P[0, 0], P[0, 1], P[1, 1])
        velocities[i] = deviation(P[2, 2], P[2, 3], P[3, 3])
    return positions, velocities
