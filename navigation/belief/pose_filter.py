"""Unscented Kalman filter of the robot pose: filterpy's filter with the models of this robot.

State: x, y, heading of R in W [m, m, rad]. Measurement: distances and bearings of k landmarks,
(d_1, b_1, d_2, b_2, ...) (2 k,) [m, rad]. It is the distribution-approximation filter of
Yoo & Kim, with Julier's sigma points for kappa = 0.
"""

from functools import partial
from math import atan2, cos, hypot, sin

import numpy as np
from filterpy.kalman import JulierSigmaPoints, UnscentedKalmanFilter, unscented_transform
from numpy.typing import NDArray

from navigation.angles import wrap, wrap_array

Array = NDArray[np.float64]


class PoseFilter:
    """Unscented Kalman filter of the pose; all landmarks of a frame are one measurement.

    Args:
        pose: x, y, heading at the start (3,) [m, m, rad].
        covariance: covariance of the start pose (3, 3).
    """

    def __init__(self, pose: Array, covariance: Array) -> None:
        self._filter = UnscentedKalmanFilter(
            dim_x=3,
            dim_z=2,  # of one landmark; `update` takes any number
            dt=0.0,  # not used by `_move`
            fx=_move,
            hx=_observe,
            points=JulierSigmaPoints(
                3, kappa=0.0, sqrt_method=partial(np.linalg.cholesky, upper=True)
            ),
            x_mean_fn=partial(_mean, angles=slice(2, None)),
            z_mean_fn=partial(_mean, angles=slice(1, None, 2)),
            residual_x=_pose_difference,
            residual_z=_measurement_difference,
            state_add=_pose_sum,
        )
        self._filter.inv = _inverse
        self.set(pose, covariance)

    @property
    def pose(self) -> Array:
        """x, y, heading of R in W (3,), a copy [m, m, rad]."""
        pose: Array = self._filter.x.copy()
        return pose

    @property
    def covariance(self) -> Array:
        """Covariance of the pose (3, 3), a copy."""
        covariance: Array = self._filter.P.copy()
        return covariance

    def set(self, pose: Array, covariance: Array) -> None:
        """Set the pose (3,) and its covariance (3, 3)."""
        self._filter.x = _pose_sum(np.asarray(pose, float), np.zeros(3))
        self._filter.P = _symmetric(np.asarray(covariance, float))

    def predict(self, increment: Array, Q: Array) -> None:
        """Predict by an odometry increment.

        Args:
            increment: odometry increment in R, midpoint rule (3,) [m, m, rad].
            Q: process noise (3, 3).

        Raises:
            numpy.linalg.LinAlgError: if the covariance is not positive definite.
        """
        self._filter.Q = Q
        self._filter.predict(increment=increment)
        self._filter.P = _symmetric(self._filter.P)

    def nis(self, z: Array, R: Array, landmarks: Array) -> Array:
        """Return the normalized innovation squared of each landmark alone (k,).

        Args:
            z: measurement (2 k,).
            R: its covariance (2 k, 2 k).
            landmarks: positions in W (k, 2) [m].

        Raises:
            numpy.linalg.LinAlgError: if the covariance of the pose is not positive definite.
        """
        f, k = self._filter, len(landmarks)
        self._redraw()
        points = np.array([_observe(point, landmarks) for point in f.sigmas_f])
        mean, S = unscented_transform(points, f.Wm, f.Wc, R, f.z_mean, f.residual_z)
        y = f.residual_z(z, mean).reshape(k, 2)
        blocks = S.reshape(k, 2, k, 2)[range(k), :, range(k), :]
        squares: Array = np.sum(y * np.linalg.solve(blocks, y[..., None])[..., 0], axis=1)
        return squares

    def update(self, z: Array, R: Array, landmarks: Array) -> None:
        """Correct by the landmarks of a frame; arguments and errors are those of `nis`."""
        self._redraw()
        self._filter.update(z, R=R, landmarks=landmarks)
        self._filter.P = _symmetric(self._filter.P)

    def is_valid(self) -> bool:
        """Return whether the pose is finite and its covariance positive definite.

        A very accurate observation of a far landmark can leave an indefinite covariance.
        """
        if not (np.isfinite(self._filter.x).all() and np.isfinite(self._filter.P).all()):
            return False
        try:
            np.linalg.cholesky(self._filter.P)
        except np.linalg.LinAlgError:
            return False
        return True

    def _redraw(self) -> None:
        """Draw the sigma points of the present pose and covariance.

        filterpy draws them in `predict` only. A second update with these points would count the
        information of the first one twice.
        """
        f = self._filter
        f.sigmas_f = f.points_fn.sigma_points(f.x, f.P)


def _symmetric(P: Array) -> Array:
    """Return a covariance without the asymmetry of rounding errors."""
    return 0.5 * (P + P.T)


def _inverse(S: Array) -> Array:
    """Return the inverse of a positive definite matrix.

    Raises:
        numpy.linalg.LinAlgError: if it is not positive definite.
    """
    root = np.linalg.inv(np.linalg.cholesky(S))
    inverse: Array = root.T @ root
    return inverse


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


def _mean(points: Array, weights: Array, angles: slice) -> Array:
    """Return the weighted mean (n,) of points (m, n), circular for the components `angles`."""
    mean: Array = weights @ points
    turned = points[:, angles]
    mean[angles] = np.arctan2(weights @ np.sin(turned), weights @ np.cos(turned))
    return mean


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
