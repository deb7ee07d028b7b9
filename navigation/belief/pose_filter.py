"""Unscented Kalman filter of the robot pose: filterpy's, with Julier's sigma points.

State: x, y, heading of R in W [m, m, rad]. Measurement: distances and bearings of k landmarks,
(d_1, b_1, d_2, b_2, ...) (2 k,) [m, rad]. It is the distribution-approximation filter of
Yoo & Kim.
"""

from math import atan2, cos, hypot, sin

import numpy as np
from filterpy.kalman import JulierSigmaPoints, UnscentedKalmanFilter, unscented_transform
from numpy.typing import NDArray

from navigation.angles import wrap, wrap_array

Array = NDArray[np.float64]


def pose_filter() -> UnscentedKalmanFilter:
    """Return the filter; its `update` takes any number of landmarks."""
    return UnscentedKalmanFilter(
        dim_x=3,
        dim_z=2,
        dt=1.0,
        fx=_move,
        hx=_observe,
        points=JulierSigmaPoints(3, kappa=0.0, sqrt_method=_upper_cholesky),
        x_mean_fn=_mean_pose,
        z_mean_fn=_mean_measurement,
        residual_x=_pose_difference,
        residual_z=_measurement_difference,
        state_add=_pose_sum,
    )


def nis(f: UnscentedKalmanFilter, z: Array, R: Array, landmarks: Array) -> Array:
    """Return the normalized innovation squared of each landmark by itself (k,).

    Args:
        f: filter with sigma points of its present state.
        z: measurement (2 k,).
        R: its covariance (2 k, 2 k).
        landmarks: in W (k, 2) [m].
    """
    points = np.array([f.hx(x, landmarks) for x in f.sigmas_f])
    mean, S = unscented_transform(points, f.Wm, f.Wc, R, f.z_mean, f.residual_z)
    k = len(landmarks)
    y = f.residual_z(z, mean).reshape(k, 2)
    blocks = S.reshape(k, 2, k, 2)[range(k), :, range(k), :]
    squares: Array = np.einsum("ki,ki->k", y, np.linalg.solve(blocks, y[:, :, None])[:, :, 0])
    return squares


def _upper_cholesky(covariance: Array) -> Array:
    upper: Array = np.asarray(np.linalg.cholesky(covariance).T, np.float64)
    return upper


def _move(pose: Array, _dt: float, increment: Array) -> Array:
    """Move a pose by an odometry increment in R (3,), midpoint rule."""
    x, y, heading = pose.tolist()
    dx, dy, turn = increment.tolist()
    middle = heading + 0.5 * turn
    c, s = cos(middle), sin(middle)
    return np.array([x + c * dx - s * dy, y + s * dx + c * dy, heading + turn])


def _observe(pose: Array, landmarks: Array) -> Array:
    """Return distances and bearings (2 k,) of landmarks in W (k, 2) from a pose."""
    x, y, heading = pose.tolist()
    polar: list[float] = []
    for u, v in landmarks.tolist():
        polar += hypot(u - x, v - y), atan2(v - y, u - x) - heading
    return np.array(polar)


def _pose_difference(a: Array, b: Array) -> Array:
    difference: Array = a - b
    difference[2] = wrap(float(difference[2]))
    return difference


def _pose_sum(pose: Array, step: Array) -> Array:
    total: Array = pose + step
    total[2] = wrap(float(total[2]))
    return total


def _measurement_difference(a: Array, b: Array) -> Array:
    difference: Array = a - b
    difference[1::2] = wrap_array(difference[1::2])
    return difference


def _mean_pose(points: Array, weights: Array) -> Array:
    mean: Array = weights @ points
    mean[2] = _mean_angle(points[:, 2:], weights)[0]
    return mean


def _mean_measurement(points: Array, weights: Array) -> Array:
    mean: Array = weights @ points
    mean[1::2] = _mean_angle(points[:, 1::2], weights)
    return mean


def _mean_angle(angles: Array, weights: Array) -> Array:
    """Return the circular means (n,) of angles (m, n)."""
    mean: Array = np.arctan2(weights @ np.sin(angles), weights @ np.cos(angles))
    return mean
