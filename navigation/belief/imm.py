"""Interacting multiple model (IMM) filters of obstacles (Blom & Bar-Shalom).

An obstacle is static, moves with constant speed and turn rate, or has reversed: modes STATIC,
FORWARD and REVERSED. Every mode has an extended Kalman filter of (x, y, vx, vy, turn rate) and a
probability. Reversing negates velocity and turn rate, so that the obstacle returns on its path.
FORWARD and REVERSED are each other's reversal; after a reversal the other mode takes over without
a mode switch. All obstacles and modes are filtered in one pass.
"""

from math import cos, exp, inf, log, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Parts = tuple[Array, Array, Array]

STATIC, FORWARD, REVERSED = 0, 1, 2
SIZE = 5  # of a state
FLOOR = 1e-6  # minimum probability of a mode


@compiled
def initialize(
    weights: Array,
    states: Array,
    covariances: Array,
    z: Array,
    R: Array,
    moving: float,
    p: np.record,
) -> None:
    """Set the filters of one obstacle to those after its first detection.

    Args:
        weights: probabilities of the modes (3,).
        states: states of the modes (3, 5).
        covariances: covariances of the modes (3, 5, 5).
        z: detected position (2,) [m].
        R: covariance of the position (2, 2) [m²].
        moving: probability that the obstacle moves [1].
        p: parameters of tracking.
    """
    states[:] = 0.0
    covariances[:] = 0.0
    for mode in range(3):
        for a in range(2):
            states[mode, a] = z[a]
            for b in range(2):
                covariances[mode, a, b] = R[a, b]
        if mode != STATIC:
            covariances[mode, 2, 2] = p.velocity_sigma * p.velocity_sigma
            covariances[mode, 3, 3] = p.velocity_sigma * p.velocity_sigma
            covariances[mode, 4, 4] = p.turn_rate_sigma * p.turn_rate_sigma
    weights[0], weights[1], weights[2] = 1.0 - moving, moving - FLOOR, FLOOR


@compiled
def transition(dt: float, p: np.record) -> Array:
    """Return the probability of mode j after mode i in a time `dt` [s] (3, 3)."""
    # An even number of reversals cancels.
    reversal = 0.5 * (1.0 - exp(-2.0 * p.reversal_rate * dt))
    stop, start = 1.0 - exp(-p.stop_rate * dt), 1.0 - exp(-p.start_rate * dt)
    stop = min(stop, 1.0 - FLOOR)  # REVERSED must keep a probability to divide by
    reversal *= 1.0 - stop
    return np.array(
        [
            [1.0 - start, start, 0.0],
            [stop, 1.0 - stop - reversal, reversal],
            [stop, reversal, 1.0 - stop - reversal],
        ]
    )


@compiled
def predict(weights: Array, states: Array, covariances: Array, dt: float, p: np.record) -> None:
    """Mix the modes of all obstacles, then predict every filter, in place.

    Args:
        weights: probabilities (n, 3).
        states: (n, 3, 5).
        covariances: (n, 3, 5, 5).
        dt: time since the last prediction [s].
        p: parameters of tracking.
    """
    mixed = mix(weights, states, covariances, transition(dt, p), dt, p)
    weights[:], states[:], covariances[:] = mixed
    move(states, covariances, dt, p)


@compiled
def _reversal(i: int, j: int) -> float:
    """Return the factor of velocity and turn rate at a switch from mode i to mode j."""
    if min(i, j) == STATIC:
        return 0.0
    return 1.0 if i == j else -1.0


@compiled
def mix(
    weights: Array, states: Array, covariances: Array, changes: Array, dt: float, p: np.record
) -> Parts:
    """Return weights, states and covariances mixed by the transitions (Blom & Bar-Shalom).

    Args:
        weights: probabilities (n, 3).
        states: (n, 3, 5).
        covariances: (n, 3, 5, 5).
        changes: probability of mode j after mode i (3, 3).
        dt: time since the last mixing [s].
        p: parameters of tracking.
    """
    n = len(weights)
    # Of an obstacle that starts to move.
    velocity_variance = p.velocity_sigma * p.velocity_sigma
    turn_variance = p.turn_rate_sigma * p.turn_rate_sigma
    mixed_weights, mixed = np.zeros((n, 3)), np.zeros((n, 3, SIZE))
    spread, parts = np.zeros((n, 3, SIZE, SIZE)), np.empty((3, SIZE))
    factor, fraction = np.ones(SIZE), np.empty(3)
    for k in range(n):
        for j in range(3):
            for i in range(3):
                mixed_weights[k, j] += weights[k, i] * changes[i, j]
            for i in range(3):
                fraction[i] = weights[k, i] * changes[i, j] / mixed_weights[k, j]
                velocity = _reversal(i, j)
                # The time of the reversal is uniform: on average half way, so that the obstacle
                # is back at its previous position.
                forth = dt if velocity < 0.0 else 0.0
                for a in range(2):
                    parts[i, a] = states[k, i, a] + forth * states[k, i, 2 + a]
                    parts[i, 2 + a] = velocity * states[k, i, 2 + a]
                parts[i, 4] = velocity * states[k, i, 4]
                for a in range(SIZE):
                    mixed[k, j, a] += fraction[i] * parts[i, a]
            for i in range(3):
                velocity = _reversal(i, j)
                factor[2] = factor[3] = factor[4] = velocity
                forth = dt if velocity < 0.0 else 0.0
                for a in range(SIZE):
                    off = parts[i, a] - mixed[k, j, a]
                    for b in range(SIZE):
                        part = covariances[k, i, a, b] * factor[a] * factor[b]
                        part += off * (parts[i, b] - mixed[k, j, b])
                        if a < 2 and b < 2:
                            square = forth * states[k, i, 2 + a] * forth * states[k, i, 2 + b]
                            part += square / 3.0
                        if a == b and a > 1 and i == STATIC and j == FORWARD:
                            part += velocity_variance if a < 4 else turn_variance
                        spread[k, j, a, b] += fraction[i] * part
    return mixed_weights, mixed, spread


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
def move(states: Array, covariances: Array, dt: float, p: np.record) -> None:
    """Predict all filters in place: constant speed and turn rate, or a random walk if static.

    Args:
        states: (n, 3, 5).
        covariances: (n, 3, 5, 5).
        dt: [s].
        p: parameters of tracking.
    """
    q, diffusion = p.acceleration_noise, p.static_diffusion
    keep = exp(-dt / p.turn_rate_time)  # autocorrelation of the turn rate
    turn_variance = p.turn_rate_sigma * p.turn_rate_sigma  # stationary
    F = np.eye(SIZE)
    moved = np.empty((SIZE, SIZE))
    for k in range(len(states)):
        P = covariances[k, STATIC]
        P[0, 0] += diffusion * dt
        P[1, 1] += diffusion * dt
        for mode in range(FORWARD, REVERSED + 1):
            x, P = states[k, mode], covariances[k, mode]
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
def mahalanobis(x: Array, P: Array, z: Array, R: Array) -> tuple[float, float]:
    """Return the squared Mahalanobis distance and log likelihood of a detection under one mode.

    Args:
        x: state of the mode (5,).
        P: its covariance (5, 5).
        z: detected position (2,) [m].
        R: covariance of the position (2, 2) [m²].

    Returns:
        Squared Mahalanobis distance [1], and log likelihood up to a constant [1].
    """
    u, v = z[0] - x[0], z[1] - x[1]
    xx, xy, yy = P[0, 0] + R[0, 0], P[0, 1] + R[0, 1], P[1, 1] + R[1, 1]
    det = xx * yy - xy * xy
    distance = (yy * u * u - 2.0 * xy * u * v + xx * v * v) / det
    return distance, -0.5 * (distance + log(det))


@compiled
def nis(states: Array, covariances: Array, z: Array, R: Array) -> float:
    """Return the normalized innovation squared of a detection under the nearest mode [1].

    Args:
        states: states of the modes of one obstacle (3, 5).
        covariances: their covariances (3, 5, 5).
        z: detected position (2,) [m].
        R: covariance of the position (2, 2) [m²].
    """
    nearest = inf
    for mode in range(3):
        nearest = min(nearest, mahalanobis(states[mode], covariances[mode], z, R)[0])
    return nearest


@compiled
def costs(
    weights: Array, states: Array, covariances: Array, z: Array, R: Array, gate: float
) -> Array:
    """Return the association costs: -2 log likelihood of every detection (n, m).

    Args:
        weights: (n, 3).
        states: (n, 3, 5).
        covariances: (n, 3, 5, 5).
        z: positions (m, 2) [m].
        R: their covariances (m, 2, 2) [m²].
        gate: squared Mahalanobis distance to the nearest mode above which the cost is infinite.
    """
    cost = np.empty((len(weights), len(z)))
    for k in range(len(weights)):
        for m in range(len(z)):
            nearest, likelihood = inf, 1e-30
            for mode in range(3):
                distance, logarithm = mahalanobis(states[k, mode], covariances[k, mode], z[m], R[m])
                nearest = min(nearest, distance)
                likelihood += weights[k, mode] * exp(logarithm)
            cost[k, m] = -2.0 * log(likelihood) if nearest < gate else inf
    return cost


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
    a, b, d = P[0, 0] + R[0, 0], P[0, 1] + R[0, 1], P[1, 1] + R[1, 1]
    det = a * d - b * b
    u, v = z[0] - x[0], z[1] - x[1]
    _, likelihood = mahalanobis(x, P, z, R)
    K, left = np.empty((SIZE, 2)), np.empty((SIZE, SIZE))
    for i in range(SIZE):
        K[i, 0] = (P[i, 0] * d - P[i, 1] * b) / det
        K[i, 1] = (P[i, 1] * a - P[i, 0] * b) / det
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


@compiled
def update(
    weights: Array, states: Array, covariances: Array, z: Array, R: Array, limit: float
) -> None:
    """Correct the filters and mode probabilities of a detected obstacle in place.

    Args:
        weights: probabilities of the modes (3,).
        states: predicted states of the modes (3, 5).
        covariances: their covariances (3, 5, 5).
        z: detected position (2,) [m].
        R: covariance of the position (2, 2) [m²].
        limit: maximum log likelihood ratio of two modes [1].
    """
    gain = np.empty(3)
    for mode in range(3):
        gain[mode] = correct(states[mode], covariances[mode], z, R)
    best = max(gain[0], gain[1], gain[2])
    for mode in range(3):
        weights[mode] *= exp(max(gain[mode] - best, -limit))
    for minimum in (0.0, FLOOR):
        total = 0.0
        for mode in range(3):
            weights[mode] = max(weights[mode], minimum)
            total += weights[mode]
        for mode in range(3):
            weights[mode] /= total


@compiled
def mean(weights: Array, states: Array) -> Array:
    """Return the mean (5,) of one obstacle, given that it moves; weights (3,), states (3, 5)."""
    moving = weights[FORWARD] + weights[REVERSED]
    average = np.empty(SIZE)
    for a in range(SIZE):
        average[a] = (
            weights[FORWARD] * states[FORWARD, a] + weights[REVERSED] * states[REVERSED, a]
        ) / moving
    return average


@compiled
def speed(weights: Array, states: Array) -> float:
    """Return the speed of one obstacle, given that it moves [m/s]; see `mean`."""
    average = mean(weights, states)
    return sqrt(average[2] * average[2] + average[3] * average[3])


@compiled
def mean_speed(weights: Array, states: Array) -> float:
    """Return the mean of the speeds of the moving modes of one obstacle [m/s].

    Modes that differ by a reversal cancel in `speed`, but not in this mean.
    """
    total = 0.0
    for mode in range(FORWARD, REVERSED + 1):
        u, v = states[mode, 2], states[mode, 3]
        total += weights[mode] * sqrt(u * u + v * v)
    return float(total / (weights[FORWARD] + weights[REVERSED]))


@compiled
def moments(weights: Array, states: Array, covariances: Array) -> tuple[Array, Array]:
    """Return mean (5,) and covariance (5, 5) of one obstacle, given that it moves; see `mean`."""
    on = weights[FORWARD] / (weights[FORWARD] + weights[REVERSED])
    back = weights[REVERSED] / (weights[FORWARD] + weights[REVERSED])
    average, covariance = np.empty(SIZE), np.empty((SIZE, SIZE))
    for a in range(SIZE):
        average[a] = on * states[FORWARD, a] + back * states[REVERSED, a]
    for a in range(SIZE):
        for b in range(SIZE):
            apart = (states[FORWARD, a] - states[REVERSED, a]) * (
                states[FORWARD, b] - states[REVERSED, b]
            )
            within = on * covariances[FORWARD, a, b] + back * covariances[REVERSED, a, b]
            covariance[a, b] = within + (on * back) * apart
    return average, covariance
