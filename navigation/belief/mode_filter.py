"""Extended Kalman filter of one mode of an obstacle: x, y, vx, vy, turn rate.

The obstacle moves with constant speed and turn rate, up to white acceleration and a turn rate that
decays.
"""

from math import cos, exp, log, sin

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]

SIZE = 5  # of a state


@compiled
def arc(turn: float, dt: float) -> tuple[float, float, float, float]:
    """Return the mean rotation of a turning velocity.

    Args:
        turn: turn rate [rad/s].
        dt: time [s].

    Returns:
        a, b of the mean velocity (a -b; b a) v over `dt` [1], and their derivatives with respect
        to the turn rate [s].
    """
    half = 0.5 * turn * dt
    c, s = cos(half), sin(half)
    # sin(h)/h and its derivative, which cancel catastrophically near zero.
    near = abs(half) < 1e-3
    sinc = 1.0 - half * half / 6.0 if near else s / half
    slope = -half / 3.0 if near else (c - sinc) / half
    by = 0.5 * dt
    return sinc * c, sinc * s, by * (slope * c - sinc * s), by * (slope * s + sinc * c)


@compiled
def advance(x: Array, P: Array, dt: float, p: np.record) -> None:
    """Predict one filter in place.

    Args:
        x: state (5,).
        P: its covariance (5, 5).
        dt: [s].
        p: parameters of tracking.
    """
    q = p.acceleration_noise
    keep = exp(-dt / p.turn_rate_time)  # autocorrelation of the turn rate
    turn_variance = p.turn_rate_sigma * p.turn_rate_sigma  # stationary
    F, moved = np.eye(SIZE), np.empty((SIZE, SIZE))
    u, v, turn = x[2], x[3], x[4]
    along, across, along_slope, across_slope = arc(turn, dt)
    c, s = cos(turn * dt), sin(turn * dt)
    F[0, 2] = F[1, 3] = dt * along
    F[1, 2] = dt * across
    F[0, 3] = -F[1, 2]
    F[0, 4] = dt * (along_slope * u - across_slope * v)
    F[1, 4] = dt * (across_slope * u + along_slope * v)
    F[2, 2] = F[3, 3] = c
    F[3, 2] = s
    F[2, 3] = -s
    F[2, 4] = -dt * (s * u + c * v)
    F[3, 4] = dt * (c * u - s * v)
    F[4, 4] = keep
    x[0] += dt * (along * u - across * v)
    x[1] += dt * (across * u + along * v)
    x[2], x[3], x[4] = c * u - s * v, s * u + c * v, keep * turn
    for a in range(SIZE):
        for b in range(SIZE):
            moved[a, b] = 0.0
            for i in range(SIZE):
                moved[a, b] += F[a, i] * P[i, b]
    for a in range(SIZE):
        for b in range(a, SIZE):
            P[a, b] = 0.0
            for i in range(SIZE):
                P[a, b] += moved[a, i] * F[b, i]
            P[b, a] = P[a, b]
    for a in range(2):
        P[a, a] += dt * dt * dt / 3.0 * (q * q)
        P[a, 2 + a] += 0.5 * dt * dt * (q * q)
        P[2 + a, a] += 0.5 * dt * dt * (q * q)
        P[2 + a, 2 + a] += dt * (q * q)
    P[4, 4] += (1.0 - keep * keep) * turn_variance


@compiled
def innovation(
    x: Array, P: Array, z: Array, R: Array
) -> tuple[float, float, float, float, float, float]:
    """Return the innovation of a detection under one mode, and the inverse of its covariance.

    Args:
        x: state of the mode (5,).
        P: its covariance (5, 5).
        z: detected position (2,) [m].
        R: covariance of the position (2, 2) [m²].

    Returns:
        Innovation u, v [m]; elements xx, xy, yy [1/m²] and determinant [1/m⁴] of the inverse.
    """
    xx, xy, yy = P[0, 0] + R[0, 0], P[0, 1] + R[0, 1], P[1, 1] + R[1, 1]
    inverse = 1.0 / (xx * yy - xy * xy)
    return z[0] - x[0], z[1] - x[1], yy * inverse, -xy * inverse, xx * inverse, inverse


@compiled
def mahalanobis(x: Array, P: Array, z: Array, R: Array) -> tuple[float, float]:
    """Return the squared Mahalanobis distance and log likelihood of a detection under one mode.

    The arguments are those of `innovation`.

    Returns:
        Squared Mahalanobis distance [1], and log likelihood up to a constant [1].
    """
    u, v, xx, xy, yy, det = innovation(x, P, z, R)
    distance = xx * u * u + 2.0 * xy * u * v + yy * v * v
    return distance, -0.5 * (distance - log(det))


@compiled
def correct(x: Array, P: Array, z: Array, R: Array) -> float:
    """Correct one filter by a detection in place (Joseph form).

    Args:
        x: predicted state (5,).
        P: its covariance (5, 5).
        z: detected position (2,) [m].
        R: its covariance (2, 2) [m²].

    Returns:
        Log likelihood of the detection, up to a constant.
    """
    u, v, xx, xy, yy, det = innovation(x, P, z, R)
    likelihood = -0.5 * (xx * u * u + 2.0 * xy * u * v + yy * v * v - log(det))
    K, left = np.empty((SIZE, 2)), np.empty((SIZE, SIZE))
    for i in range(SIZE):
        K[i, 0] = P[i, 0] * xx + P[i, 1] * xy
        K[i, 1] = P[i, 0] * xy + P[i, 1] * yy
    for i in range(SIZE):
        x[i] += K[i, 0] * u + K[i, 1] * v
        for j in range(SIZE):
            left[i, j] = P[i, j] - K[i, 0] * P[0, j] - K[i, 1] * P[1, j]
    for i in range(SIZE):
        for j in range(i, SIZE):
            # (left - left H' K') + K R K', averaged with its transpose.
            noise = K[i, 0] * (R[0, 0] * K[j, 0] + R[0, 1] * K[j, 1])
            noise += K[i, 1] * (R[0, 1] * K[j, 0] + R[1, 1] * K[j, 1])
            upper = left[i, j] - left[i, 0] * K[j, 0] - left[i, 1] * K[j, 1]
            lower = left[j, i] - left[j, 0] * K[i, 0] - left[j, 1] * K[i, 1]
            P[i, j] = P[j, i] = 0.5 * (upper + lower) + noise
    return likelihood
