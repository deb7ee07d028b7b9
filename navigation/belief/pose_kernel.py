"""Compiled part of localization: what an unscented filter does to all its sigma points.

Of a vector every `period`-th entry is an angle: the third of a pose (3), every second one of a
measurement (distance, bearing, distance, bearing, ...) (2).
"""

from math import atan2, ceil, cos, hypot, pi, sin, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True)
def wrapped(a: float) -> float:
    """An angle in (-pi, pi] [rad]."""
    return a - 2.0 * pi * ceil((a - pi) / (2.0 * pi))


@njit(cache=True)
def root(covariance: Array) -> Array:
    """Upper factor of Cholesky's of a symmetric matrix (n, n); zero if it is not definite."""
    n = len(covariance)
    upper = np.zeros((n, n))
    for i in range(n):
        square = covariance[i, i]
        for k in range(i):
            square -= upper[k, i] ** 2
        if not square > 0.0:
            return np.zeros((n, n))
        upper[i, i] = sqrt(square)
        for j in range(i + 1, n):
            rest = covariance[i, j]
            for k in range(i):
                rest -= upper[k, i] * upper[k, j]
            upper[i, j] = rest / upper[i, i]
    return upper


@njit(cache=True)
def sigma_points(pose: Array, upper: Array) -> Array:
    """Julier's points (2 n + 1, n) of a mean (n,) and a factor of (n + kappa) P (n, n)."""
    n = len(pose)
    points = np.empty((2 * n + 1, n))
    for i in range(n):
        points[0, i] = pose[i]
        for k in range(n):
            points[1 + k, i] = pose[i] + upper[k, i]
            points[1 + n + k, i] = pose[i] - upper[k, i]
    return points


@njit(cache=True)
def moved(poses: Array, increment: Array) -> Array:
    """Poses (n, 3) after an odometry increment in R (3,), midpoint rule [m, m, rad]."""
    after = np.empty_like(poses)
    for i in range(len(poses)):
        middle = poses[i, 2] + 0.5 * increment[2]
        c, s = cos(middle), sin(middle)
        after[i, 0] = poses[i, 0] + c * increment[0] - s * increment[1]
        after[i, 1] = poses[i, 1] + s * increment[0] + c * increment[1]
        after[i, 2] = poses[i, 2] + increment[2]
    return after


@njit(cache=True)
def sighted(pose: Array, landmarks: Array) -> Array:
    """Ranges and bearings (2 k,) of landmarks (k, 2) from a pose (3,) [m, rad]."""
    seen = np.empty(2 * len(landmarks))
    for i in range(len(landmarks)):
        dx, dy = landmarks[i, 0] - pose[0], landmarks[i, 1] - pose[1]
        seen[2 * i] = hypot(dx, dy)
        seen[2 * i + 1] = wrapped(atan2(dy, dx) - pose[2])
    return seen


@njit(cache=True)
def difference(a: Array, b: Array, period: int) -> Array:
    """A - b (n,), angles wrapped."""
    rest = np.empty(len(a))
    for i in range(len(a)):
        rest[i] = a[i] - b[i]
    for i in range(period - 1, len(a), period):
        rest[i] = wrapped(rest[i])
    return rest


@njit(cache=True)
def mean(points: Array, weights: Array, period: int) -> Array:
    """Weighted mean (n,) of points (m, n); of angles that of their directions."""
    m, n = points.shape
    total = np.zeros(n)
    for k in range(m):
        for i in range(n):
            total[i] += weights[k] * points[k, i]
    for i in range(period - 1, n, period):
        c = s = 0.0
        for k in range(m):
            c += weights[k] * cos(points[k, i])
            s += weights[k] * sin(points[k, i])
        total[i] = atan2(s, c)
    return total


@njit(cache=True)
def covariance_of(a: Array, b: Array, weights: Array) -> Array:
    """Sum of weights (m,) times outer products of differences a (m, n) and b (m, l): (n, l)."""
    total = np.zeros((a.shape[1], b.shape[1]))
    for k in range(len(weights)):
        for i in range(a.shape[1]):
            for j in range(b.shape[1]):
                total[i, j] += weights[k] * a[k, i] * b[k, j]
    return total


@njit(cache=True)
def differences(points: Array, centre: Array, period: int) -> Array:
    """Points (m, n) less a centre (n,), angles wrapped (m, n)."""
    m, n = points.shape
    rest = np.empty((m, n))
    for k in range(m):
        for i in range(n):
            rest[k, i] = points[k, i] - centre[i]
        for i in range(period - 1, n, period):
            rest[k, i] = wrapped(rest[k, i])
    return rest


@njit(cache=True)
def transform(
    points: Array, mean_weights: Array, weights: Array, noise: Array, period: int
) -> tuple[Array, Array]:
    """Unscented transform: mean (n,) and covariance (n, n) of points (m, n) (Julier & Uhlmann).

    Args:
        points: transformed sigma points (m, n).
        mean_weights: of the mean (m,).
        weights: of the covariance (m,).
        noise: added to the covariance (n, n).
        period: from one angle to the next.
    """
    centre = mean(points, mean_weights, period)
    spread = differences(points, centre, period)
    covariance = covariance_of(spread, spread, weights)
    for i in range(len(centre)):
        for j in range(len(centre)):
            covariance[i, j] += noise[i, j]
    return centre, covariance


@njit(cache=True)
def cross_covariance(
    poses: Array, pose: Array, seen: Array, mean_seen: Array, weights: Array, period: int
) -> Array:
    """Covariance (3, 2 k) of poses (m, 3) about `pose` with measurements about `mean_seen`.

    Args:
        poses: sigma points (m, 3).
        pose: their mean (3,).
        seen: what is measured from each (m, 2 k).
        mean_seen: its mean (2 k,).
        weights: of the covariance (m,).
        period: of a measurement.
    """
    return covariance_of(
        differences(poses, pose, len(pose)), differences(seen, mean_seen, period), weights
    )


@njit(cache=True)
def together(noise: Array, shared: float, limit: float) -> Array:
    """Covariance (2 k, 2 k) of sightings whose bearings have one error in common.

    Args:
        noise: covariance of every sighting by itself (k, 2, 2).
        shared: variance of the common error [rad²].
        limit: largest share that it may have in the variance of a bearing [1].
    """
    n = len(noise)
    common, covariance = shared, np.zeros((2 * n, 2 * n))
    for i in range(n):
        common = min(common, limit * noise[i, 1, 1])
    for i in range(n):
        for j in range(n):
            covariance[2 * i + 1, 2 * j + 1] = common
        for a in range(2):
            for b in range(2):
                covariance[2 * i + a, 2 * i + b] = noise[i, a, b]
    return covariance


@njit(cache=True)
def nis(
    poses: Array, mean_weights: Array, weights: Array, landmarks: Array, z: Array, noise: Array
) -> Array:
    """Normalised innovation squared of the sighting of every landmark by itself (k,).

    Args:
        poses: sigma points (m, 3).
        mean_weights: of the mean (m,).
        weights: of the covariance (m,).
        landmarks: in W (k, 2) [m].
        z: range and bearing of each (k, 2) [m, rad].
        noise: its covariance (k, 2, 2).
    """
    squares = np.empty(len(landmarks))
    seen = np.empty((len(poses), 2))
    for i in range(len(landmarks)):
        for k in range(len(poses)):
            seen[k, 0], seen[k, 1] = sighted(poses[k], landmarks[i : i + 1])
        centre, S = transform(seen, mean_weights, weights, noise[i], z.shape[1])
        u, w = z[i, 0] - centre[0], wrapped(z[i, 1] - centre[1])
        a, b, d = S[0, 0], S[0, 1], S[1, 1]
        squares[i] = (d * u * u - 2.0 * b * u * w + a * w * w) / (a * d - b * b)
    return squares
