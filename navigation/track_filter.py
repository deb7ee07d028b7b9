"""Linear Kalman filters of obstacles, stacked: all tracks in one array operation.

Two models of every obstacle: constant velocity (x, y, vx, vy) with white acceleration,
and standing still (x, y) with a small random walk. Both measure the position in W.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Innovation(NamedTuple):
    """Difference of measured and predicted positions.

    Attributes:
        residual: (n, 2) [m].
        inverse: inverse innovation covariance (n, 2, 2).
        distance: squared Mahalanobis distance (n,).
        log_det: logarithm of the determinant of the innovation covariance (n,).
    """

    residual: Array
    inverse: Array
    distance: Array
    log_det: Array

    @property
    def log_likelihood(self) -> Array:
        """Gaussian log likelihood up to a constant (n,)."""
        likelihood: Array = -0.5 * (self.distance + self.log_det)
        return likelihood


def predict_moving(x: Array, P: Array, dt: float, q: float) -> tuple[Array, Array]:
    """Constant velocity over `dt`.

    Args:
        x: states (n, 4).
        P: covariances (n, 4, 4).
        dt: [s].
        q: square root of the density of the white acceleration [m/s^1.5].

    Returns:
        Predicted states and covariances.
    """
    moved = x.copy()
    moved[:, :2] += dt * x[:, 2:]
    A, B, D = P[:, :2, :2], P[:, :2, 2:], P[:, 2:, 2:]
    spread = np.empty_like(P)
    noise = q * q * np.eye(2)
    Bt = np.swapaxes(B, 1, 2)
    spread[:, :2, :2] = A + dt * (B + Bt) + (dt * dt) * D + (dt**3 / 3.0) * noise
    cross = B + dt * D + (0.5 * dt * dt) * noise
    spread[:, :2, 2:] = cross
    spread[:, 2:, :2] = np.swapaxes(cross, 1, 2)
    spread[:, 2:, 2:] = D + dt * noise
    return moved, spread


def innovation(x: Array, P: Array, z: Array, R: Array) -> Innovation:
    """Innovation of position measurements; leading axes broadcast.

    Args:
        x: predicted positions (..., 2) [m].
        P: their covariances (..., 2, 2) [m²].
        z: measured positions (..., 2) [m].
        R: their covariances (..., 2, 2) [m²].
    """
    residual = z - x
    S = P + R
    a, b, d = S[..., 0, 0], S[..., 0, 1], S[..., 1, 1]
    det = a * d - b * b
    inverse = np.empty(S.shape)
    inverse[..., 0, 0] = d / det
    inverse[..., 1, 1] = a / det
    inverse[..., 0, 1] = inverse[..., 1, 0] = -b / det
    u, v = residual[..., 0], residual[..., 1]
    distance = (d * u * u - 2.0 * b * u * v + a * v * v) / det
    return Innovation(residual, inverse, distance, np.log(det))


def update(x: Array, P: Array, R: Array, seen: Innovation) -> tuple[Array, Array]:
    """Correct states whose first two entries were measured, in Joseph's form.

    Args:
        x: predicted states (n, k).
        P: covariances (n, k, k).
        R: measurement covariances (n, 2, 2).
        seen: innovation of these states, with the same `R`.

    Returns:
        Corrected states and covariances, exactly symmetric.
    """
    K = P[:, :, :2] @ seen.inverse
    corrected = x + (K @ seen.residual[:, :, None])[:, :, 0]
    keep = np.broadcast_to(np.eye(P.shape[1]), P.shape).copy()
    keep[:, :, :2] -= K
    P = keep @ P @ np.swapaxes(keep, 1, 2) + K @ R @ np.swapaxes(K, 1, 2)
    return corrected, 0.5 * (P + np.swapaxes(P, 1, 2))
