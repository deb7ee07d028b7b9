"""Unscented Kalman filter of a pose that sees landmarks: filterpy's, with Julier's points.

It is the distribution-approximation filter of Yoo & Kim. The filter is filterpy's; its loops
over the sigma points, in Python there, are compiled here.
"""

import numpy as np
from filterpy.kalman import JulierSigmaPoints, UnscentedKalmanFilter
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief import pose_kernel
from navigation.transform import yaw_rotation

Array = NDArray[np.float64]

# Every third entry of a state and every second of a measurement is an angle.
STATE = 3
MEASUREMENT = 2
ONE = np.eye(3)


def _root(covariance: Array) -> Array:
    upper = pose_kernel.root(covariance)
    if upper[0, 0] == 0.0:
        raise np.linalg.LinAlgError("the covariance of the pose is not positive definite")
    return upper


def _seen(pose: Array, landmarks: Array) -> Array:
    return pose_kernel.sighted(pose, landmarks)


def _difference(a: Array, b: Array) -> Array:
    return pose_kernel.difference(a, b, MEASUREMENT)


def _moved_on(state: Array, step: Array) -> Array:
    total: Array = state + step
    total[2] = wrap(float(total[2]))
    return total


def _state(points: Array, mean: Array, weights: Array, noise: Array, *_: object) -> object:
    return pose_kernel.transform(points, mean, weights, noise, STATE)


def _measurement(points: Array, mean: Array, weights: Array, noise: Array, *_: object) -> object:
    return pose_kernel.transform(points, mean, weights, noise, MEASUREMENT)


class PosePoints(JulierSigmaPoints):  # type: ignore[misc]  # filterpy has no types
    """Julier's sigma points of a pose; weights and form are filterpy's."""

    def __init__(self) -> None:
        super().__init__(3, kappa=0.0, sqrt_method=_root)

    def sigma_points(self, x: Array, P: Array) -> Array:
        """Points (7, 3) of mean (3,) and covariance (3, 3).

        Raises:
            numpy.linalg.LinAlgError: the covariance is not positive definite.
        """
        return pose_kernel.sigma_points(x, self.sqrt((self.n + self.kappa) * P))


class PoseFilter(UnscentedKalmanFilter):  # type: ignore[misc]  # filterpy has no types
    """State: x, y, heading of R in W [m, m, rad].

    Attributes:
        x: mean (3,), heading wrapped.
        P: covariance (3, 3), exactly symmetric.
    """

    x: Array
    P: Array

    def __init__(self) -> None:
        super().__init__(
            dim_x=3,
            dim_z=2,
            dt=1.0,
            hx=_seen,
            fx=None,
            points=PosePoints(),
            residual_z=_difference,
            state_add=_moved_on,
        )

    def move(self, increment: Array, covariance: Array, drift: float) -> None:
        """Predict.

        Args:
            increment: of the odometry, in R (3,) [m, m, rad].
            covariance: of its error (3, 3).
            drift: variance of every component that it lacks [m², rad²].

        Raises:
            numpy.linalg.LinAlgError: the covariance is not positive definite.
        """
        rotation = yaw_rotation(float(self.x[2]))
        self.Q = rotation @ covariance @ rotation.T + drift * ONE
        self.predict(UT=_state, increment=increment)
        self._tidy()

    def spread(self) -> None:
        """Lay the sigma points anew: filterpy keeps those of the prediction.

        Raises:
            numpy.linalg.LinAlgError: the covariance is not positive definite.
        """
        self.sigmas_f: Array = self.points_fn.sigma_points(self.x, self.P)

    def nis(self, z: Array, noise: Array, landmarks: Array) -> Array:
        """Normalised innovation squared of sightings (k, 2) of landmarks (k, 2), each by itself.

        Args:
            z: ranges and bearings (k, 2) [m, rad].
            noise: their covariances (k, 2, 2).
            landmarks: in W (k, 2) [m].

        Returns:
            (k,), after `spread`.
        """
        return pose_kernel.nis(self.sigmas_f, self.Wm, self.Wc, landmarks, z, noise)

    def correct(self, z: Array, noise: Array, landmarks: Array) -> None:
        """Take in sightings as one measurement, after `spread`; arguments as `nis`.

        Args:
            z: ranges and bearings (k, 2) [m, rad].
            noise: covariance of all of them (2 k, 2 k).
            landmarks: in W (k, 2) [m].
        """
        self.update(z.ravel(), R=noise, UT=_measurement, landmarks=landmarks)
        self._tidy()

    def _tidy(self) -> None:
        self.x[2] = wrap(float(self.x[2]))
        self.P = 0.5 * (self.P + self.P.T)

    def compute_process_sigmas(self, dt: float, fx: object = None, **fx_args: Array) -> None:
        """Filterpy's hook: the sigma points, moved by ``increment``."""
        points = self.points_fn.sigma_points(self.x, self.P)
        self.sigmas_f = pose_kernel.moved(points, fx_args["increment"])

    def cross_variance(self, x: Array, z: Array, sigmas_f: Array, sigmas_h: Array) -> Array:
        """Filterpy's hook: covariance of state and measurement (3, 2 k)."""
        return pose_kernel.cross_covariance(sigmas_f, x, sigmas_h, z, self.Wc, MEASUREMENT)
