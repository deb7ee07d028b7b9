"""Unscented Kalman filter of the robot pose, with Julier's sigma points for kappa = 0.

State: x, y, heading of R in W [m, m, rad]. Measurement: distances and bearings of k landmarks,
(d_1, b_1, d_2, b_2, ...) (2 k,) [m, rad]. It is the distribution-approximation filter of
Yoo & Kim. The six sigma points x +- columns of the Cholesky factor of 3 P have equal weights.
"""

from math import atan2, cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from navigation.angles import wrap

Array = NDArray[np.float64]

POINTS = 6  # sigma points


@compiled
def cholesky(A: Array, L: Array) -> bool:
    """Write the lower Cholesky factor of A (n, n) to L; return whether A is positive definite."""
    L[:] = 0.0
    for i in range(len(A)):
        for j in range(i + 1):
            total = A[i, j]
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i == j and not total > 0.0:  # also if NaN
                return False
            L[i, j] = sqrt(total) if i == j else total / L[j, j]
    return True


@compiled
def solve(L: Array, b: Array) -> None:
    """Solve L L' x = b (n,) in place, with a Cholesky factor L (n, n)."""
    n = len(b)
    for i in range(n):
        for k in range(i):
            b[i] -= L[i, k] * b[k]
        b[i] /= L[i, i]
    for j in range(n):
        i = n - 1 - j
        for k in range(i + 1, n):
            b[i] -= L[k, i] * b[k]
        b[i] /= L[i, i]


@compiled
def sigma_points(pose: Array, P: Array) -> tuple[Array, bool]:
    """Return the sigma points (6, 3), and whether the covariance P (3, 3) is positive definite."""
    points, L = np.empty((POINTS, 3)), np.empty((3, 3))
    positive = cholesky(3.0 * P, L)
    for k in range(3):
        for a in range(3):
            points[k, a], points[3 + k, a] = pose[a] + L[a, k], pose[a] - L[a, k]
    return points, positive


@compiled
def center(points: Array, first_angle: int) -> Array:
    """Return the mean (n,) of points (6, n), and subtract it from them.

    Args:
        points: points, of which each third component of poses or each second one of measurements
            is an angle [rad].
        first_angle: index of the first angle: 2 of poses, 1 of measurements.
    """
    n = points.shape[1]
    mean = np.empty(n)
    for a in range(n):
        angle = a % (first_angle + 1) == first_angle
        x = y = 0.0
        for i in range(POINTS):
            x += cos(points[i, a]) if angle else points[i, a]
            y += sin(points[i, a]) if angle else 0.0
        mean[a] = atan2(y, x) if angle else x / POINTS
        for i in range(POINTS):
            points[i, a] -= mean[a]
            if angle:
                points[i, a] = wrap(points[i, a])
    return mean


@compiled
def covariance(a: Array, b: Array) -> Array:
    """Return the covariance (n, m) of centred points (6, n) and (6, m)."""
    result = np.zeros((a.shape[1], b.shape[1]))
    for i in range(POINTS):
        for j in range(a.shape[1]):
            for k in range(b.shape[1]):
                result[j, k] += a[i, j] * b[i, k] / POINTS
    return result


@compiled
def predict(pose: Array, P: Array, increment: Array, Q: Array) -> bool:
    """Predict pose (3,) and covariance P (3, 3) in place; return whether P was positive definite.

    Args:
        pose: x, y, heading [m, m, rad].
        P: its covariance.
        increment: odometry increment in R, midpoint rule (3,) [m, m, rad].
        Q: process noise (3, 3).
    """
    points, positive = sigma_points(pose, P)
    if not positive:
        return False
    for point in points:
        middle = point[2] + 0.5 * increment[2]
        c, s = cos(middle), sin(middle)
        point[0] += c * increment[0] - s * increment[1]
        point[1] += s * increment[0] + c * increment[1]
        point[2] += increment[2]
    pose[:] = center(points, 2)
    P[:] = covariance(points, points) + 0.5 * (Q + Q.T)
    return True


@compiled
def expected(points: Array, landmarks: Array) -> Array:
    """Return distances and bearings (6, 2 k) of landmarks in W (k, 2) from poses (6, 3)."""
    z = np.empty((POINTS, 2 * len(landmarks)))
    for i in range(POINTS):
        for k in range(len(landmarks)):
            dx, dy = landmarks[k, 0] - points[i, 0], landmarks[k, 1] - points[i, 1]
            z[i, 2 * k] = sqrt(dx * dx + dy * dy)
            z[i, 2 * k + 1] = atan2(dy, dx) - points[i, 2]
    return z


@compiled
def innovation(
    pose: Array, P: Array, z: Array, R: Array, landmarks: Array
) -> tuple[Array, Array, Array, bool]:
    """Return innovation (m,), its covariance (m, m), the covariance of pose and measurement (3, m).

    Args:
        pose: x, y, heading [m, m, rad].
        P: its covariance (3, 3).
        z: measurement (m,), m = 2 k.
        R: its covariance (m, m).
        landmarks: positions in W (k, 2) [m].

    Returns:
        These three, and whether P is positive definite.
    """
    points, positive = sigma_points(pose, P)
    measured = expected(points, landmarks)
    y = z - center(measured, 1)
    for k in range(len(landmarks)):
        y[2 * k + 1] = wrap(y[2 * k + 1])
    center(points, 2)
    return y, covariance(measured, measured) + R, covariance(points, measured), positive


@compiled
def nis(pose: Array, P: Array, z: Array, R: Array, landmarks: Array) -> Array:
    """Return the normalized innovation squared of each landmark alone (k,); see `innovation`."""
    y, S, _, positive = innovation(pose, P, z, R, landmarks)
    squares = np.empty(len(landmarks))
    for k in range(len(landmarks)):
        u, v = y[2 * k], y[2 * k + 1]
        a, b, d = S[2 * k, 2 * k], S[2 * k, 2 * k + 1], S[2 * k + 1, 2 * k + 1]
        squares[k] = (d * u * u - 2.0 * b * u * v + a * v * v) / (a * d - b * b)
    return squares if positive else np.full(len(landmarks), np.inf)


@compiled
def correct(pose: Array, P: Array, z: Array, R: Array, landmarks: Array) -> bool:
    """Correct pose and P in place by a measurement; return whether both covariances are positive.

    Arguments are those of `innovation`.
    """
    y, S, cross, positive = innovation(pose, P, z, R, landmarks)
    L = np.empty(S.shape)
    if not (positive and cholesky(S, L)):
        return False
    K = cross.copy()
    for a in range(3):
        solve(L, K[a])
    for a in range(3):
        for k in range(len(y)):
            pose[a] += K[a, k] * y[k]
        for b in range(a + 1):
            # K S K' = K C', C the covariance of pose and measurement.
            for k in range(len(y)):
                P[a, b] -= 0.5 * (K[a, k] * cross[b, k] + K[b, k] * cross[a, k])
            P[b, a] = P[a, b]
    pose[2] = wrap(pose[2])
    return True


@compiled
def is_valid(pose: Array, P: Array) -> bool:
    """Return whether the pose is finite and its covariance positive definite.

    A very accurate observation of a far landmark can leave an indefinite covariance.
    """
    finite = abs(pose[0]) < np.inf and abs(pose[1]) < np.inf and abs(pose[2]) <= 2.0 * pi
    return bool(finite and np.isfinite(P).all() and cholesky(P, np.empty((3, 3))))
