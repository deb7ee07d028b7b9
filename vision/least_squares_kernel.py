"""Least squares of three unknowns with correlated measurements, compiled."""

from math import sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True)
def whiten(R: Array, H: Array, residual: Array) -> None:
    """Cholesky factor of R in its lower half, and its inverse applied to H and to the residual."""
    for i in range(len(residual)):
        for j in range(i + 1):
            total = R[i, j]
            for k in range(j):
                total -= R[i, k] * R[j, k]
            R[i, j] = sqrt(total) if i == j else total / R[j, j]
        for j in range(3):
            total = H[i, j]
            for k in range(i):
                total -= R[i, k] * H[k, j]
            H[i, j] = total / R[i, i]
        total = residual[i]
        for k in range(i):
            total -= R[i, k] * residual[k]
        residual[i] = total / R[i, i]


@njit(cache=True)
def step(x: Array, P: Array, H: Array, residual: Array) -> None:
    """One step of x to the least squares of whitened rows; fill its covariance P (3, 3)."""
    N, g = np.zeros((3, 3)), np.zeros(3)
    for i in range(len(residual)):
        for j in range(3):
            g[j] += H[i, j] * residual[i]
            for k in range(3):
                N[j, k] += H[i, j] * H[i, k]
    for i in range(3):
        a, b = (i + 1) % 3, (i + 2) % 3
        for j in range(3):
            c, e = (j + 1) % 3, (j + 2) % 3
            P[j, i] = N[a, c] * N[b, e] - N[a, e] * N[b, c]
    determinant = N[0, 0] * P[0, 0] + N[0, 1] * P[1, 0] + N[0, 2] * P[2, 0]
    for i in range(3):
        for j in range(3):
            P[i, j] /= determinant
    for i in range(3):
        x[i] += P[i, 0] * g[0] + P[i, 1] * g[1] + P[i, 2] * g[2]


@njit(cache=True)
def positive(P: Array) -> bool:
    """Whether P (3, 3) is positive definite."""
    minor = P[0, 0] * P[1, 1] - P[0, 1] * P[1, 0]
    determinant = (
        P[2, 2] * minor
        - P[2, 1] * (P[0, 0] * P[1, 2] - P[0, 2] * P[1, 0])
        + P[2, 0] * (P[0, 1] * P[1, 2] - P[0, 2] * P[1, 1])
    )
    return bool(P[0, 0] > 0.0 and minor > 0.0 and determinant > 0.0)
