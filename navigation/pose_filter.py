"""Unscented Kalman filter of a pose that sees landmarks, with Julier's sigma points.

It is the distribution-approximation filter of Yoo & Kim (S. J. Julier, J. K. Uhlmann, Unscented
filtering and nonlinear estimation, Proc. IEEE 92(3), 2004, with kappa 0). A test holds it against
filterpy's.
"""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation import pose_kernel
from navigation.angles import wrap

Array = NDArray[np.float64]

# Every so many entries an angle.
STATE = 3
MEASUREMENT = 2

# Of the sigma points: the mean itself, and three to each side of it.
WEIGHTS = np.array([0.0, *[0.5 / STATE] * (2 * STATE)])


class PoseFilter:
    """State: x, y, heading of R in W [m, m, rad].

    Attributes:
        x: mean (3,), heading wrapped.
        P: covariance (3, 3), exactly symmetric.
    """

    def __init__(self) -> None:
        self.x: Array = np.zeros(STATE)
        self.P: Array = np.eye(STATE)
        self._points: Array = np.zeros((len(WEIGHTS), STATE))

    def move(self, increment: Array, covariance: Array, drift: float) -> None:
        """Predict.

        Args:
            increment: of the odometry, in R (3,) [m, m, rad].
            covariance: of its error (3, 3).
            drift: variance of every component that it lacks [m², rad²].

        Raises:
            numpy.linalg.LinAlgError: the covariance is not positive definite.
        """
        heading = float(self.x[2])
        c, s = cos(heading), sin(heading)
        to_world = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        Q = to_world @ covariance @ to_world.T + drift * np.eye(3)
        self.spread()
        points = pose_kernel.moved(self._points, increment)
        self.x, self.P = pose_kernel.transform(points, WEIGHTS, WEIGHTS, Q, STATE)
        self._tidy()

    def spread(self) -> None:
        """Lay the sigma points around the present mean.

        Raises:
            numpy.linalg.LinAlgError: the covariance is not positive definite.
        """
        upper = pose_kernel.root(STATE * self.P)
        if upper[0, 0] == 0.0:
            raise np.linalg.LinAlgError("the covariance of the pose is not positive definite")
        self._points = pose_kernel.sigma_points(self.x, upper)

    def distances(self, z: Array, noise: Array, landmarks: Array) -> Array:
        """Normalised innovation squared of sightings (k, 2) of landmarks (k, 2), each by itself.

        Args:
            z: ranges and bearings (k, 2) [m, rad].
            noise: their covariances (k, 2, 2).
            landmarks: in W (k, 2) [m].

        Returns:
            (k,), after `spread`.
        """
        return pose_kernel.distances(self._points, WEIGHTS, WEIGHTS, landmarks, z, noise)

    def correct(self, z: Array, noise: Array, landmarks: Array) -> None:
        """Take in sightings as one measurement, after `spread`.

        Args:
            z: ranges and bearings (k, 2) [m, rad].
            noise: covariance of all of them (2 k, 2 k).
            landmarks: in W (k, 2) [m].

        Raises:
            numpy.linalg.LinAlgError: the covariance of the measurement is singular.
        """
        seen = pose_kernel.sighted_from(self._points, landmarks)
        expected, S = pose_kernel.transform(seen, WEIGHTS, WEIGHTS, noise, MEASUREMENT)
        shared = pose_kernel.cross_covariance(
            self._points, self.x, seen, expected, WEIGHTS, MEASUREMENT
        )
        K = np.dot(shared, np.linalg.inv(S))
        self.x = self.x + np.dot(K, pose_kernel.difference(z.ravel(), expected, MEASUREMENT))
        self.P = self.P - np.dot(K, np.dot(S, K.T))
        self._tidy()

    def _tidy(self) -> None:
        self.x[2] = wrap(float(self.x[2]))
        self.P = 0.5 * (self.P + self.P.T)
