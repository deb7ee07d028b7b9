"""Interacting multiple model (IMM) filters of obstacles (Blom & Bar-Shalom).

An obstacle is static, moves with constant speed and turn rate, or has reversed: modes STATIC,
FORWARD and REVERSED. Every mode has an extended Kalman filter of (x, y, vx, vy, turn rate) and a
probability. Reversing negates velocity and turn rate, so that the obstacle returns on its path.
FORWARD and REVERSED are each other's reversal; after a reversal the other mode takes over without
a mode switch. All obstacles and modes are filtered in one pass.
"""

from math import exp, inf, log, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from navigation.belief.mode_filter import SIZE, advance, correct, mahalanobis

Array = NDArray[np.float64]
Parts = tuple[Array, Array, Array]

STATIC, FORWARD, REVERSED = 0, 1, 2
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
def move(states: Array, covariances: Array, dt: float, p: np.record) -> None:
    """Predict all filters in place: constant speed and turn rate, or a random walk if static.

    Args:
        states: (n, 3, 5).
        covariances: (n, 3, 5, 5).
        dt: [s].
        p: parameters of tracking.
    """
    for k in range(len(states)):
        for a in range(2):
            covariances[k, STATIC, a, a] += p.static_diffusion * dt
        for mode in range(FORWARD, REVERSED + 1):
            advance(states[k, mode], covariances[k, mode], dt, p)


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
