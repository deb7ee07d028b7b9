"""Compiled part of the obstacle set: how uncertain places and velocities are."""

from math import hypot, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True)
def deviation(xx: float, xy: float, yy: float) -> float:
    """sqrt(lambda_max) of the symmetric matrix of these entries."""
    return sqrt(max(0.5 * (xx + yy) + hypot(0.5 * (xx - yy), xy), 0.0))


@njit(cache=True)
def deviations(covariances: Array) -> tuple[Array, Array]:
    """sqrt(lambda_max) of the blocks of positions and velocities of (n, 4, 4): (n,), (n,)."""
    n = len(covariances)
    places, velocities = np.empty(n), np.empty(n)
    for i in range(n):
        P = covariances[i]
        places[i] = deviation(P[0, 0], P[0, 1], P[1, 1])
        velocities[i] = deviation(P[2, 2], P[2, 3], P[3, 3])
    return places, velocities
