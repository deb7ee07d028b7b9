"""Compiled part of the clouds of lost movers."""

from math import cos, exp, log, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True)
def advance(
    positions: Array,
    velocities: Array,
    turn_rates: Array,
    bends: Array,
    draws: Array,
    wander: tuple[float, float],
    probability: float,
    dt: float,
) -> tuple[Array, Array, Array]:
    """Move on for `dt` [s]; particles whose draw is below the probability turn back.

    Args:
        positions: (n, 2) [m].
        velocities: (n, 2) [m/s].
        turn_rates: of the velocities (n,) [rad/s].
        bends: standard normal (n,).
        draws: uniform in [0, 1) (n,).
        wander: share of a turn rate that is left after dt [1], and what a bend adds [rad/s].
        probability: of turning back on its path [1].
        dt: [s].

    Returns:
        Positions, velocities and turn rates, new.
    """
    moved, turned = np.empty_like(positions), np.empty_like(velocities)
    rates = np.empty_like(turn_rates)
    for i in range(len(draws)):
        sign = -1.0 if draws[i] < probability else 1.0
        u, v = sign * velocities[i, 0], sign * velocities[i, 1]
        rate = sign * (wander[0] * turn_rates[i] + wander[1] * bends[i])
        angle = rate * dt
        # Over a time so short the mean velocity is that of its middle.
        c, s = cos(0.5 * angle), sin(0.5 * angle)
        moved[i, 0] = positions[i, 0] + dt * (c * u - s * v)
        moved[i, 1] = positions[i, 1] + dt * (s * u + c * v)
        c, s = cos(angle), sin(angle)
        turned[i, 0], turned[i, 1], rates[i] = c * u - s * v, s * u + c * v, rate
    return moved, turned, rates


@njit(cache=True)
def moments(positions: Array, velocities: Array, weights: Array) -> tuple[Array, Array]:
    """Mean (4,) and covariance (4, 4) of x, y, vx, vy.

    Args:
        positions: (n, 2) [m].
        velocities: (n, 2) [m/s].
        weights: sum to one (n,).
    """
    mean, covariance = np.zeros(4), np.zeros((4, 4))
    for i in range(len(weights)):
        for a in range(2):
            mean[a] += weights[i] * positions[i, a]
            mean[2 + a] += weights[i] * velocities[i, a]
    off = np.empty(4)
    for i in range(len(weights)):
        for a in range(2):
            off[a] = positions[i, a] - mean[a]
            off[2 + a] = velocities[i, a] - mean[2 + a]
        for a in range(4):
            for b in range(4):
                covariance[a, b] += weights[i] * (off[a] * off[b])
    return mean, covariance


@njit(cache=True)
def log_density(
    positions: Array, weights: Array, z: Array, variance: Array, jitter: float
) -> Array:
    """Log density of a smoothed cloud at points (m,), up to log(2 pi).

    Each particle is as wide as Scott's rule for the cloud's spread says, so that the gaps
    between a few particles far apart are no holes.

    Args:
        positions: (n, 2) [m].
        weights: sum to one (n,).
        z: points (m, 2) [m].
        variance: widening for each point (m,) [m²].
        jitter: least width of a particle [m].
    """
    x = y = square = share = 0.0
    for i in range(len(weights)):
        x += weights[i] * positions[i, 0]
        y += weights[i] * positions[i, 1]
        square += weights[i] * weights[i]
    for i in range(len(weights)):
        dx, dy = positions[i, 0] - x, positions[i, 1] - y
        share += weights[i] * (dx * dx + dy * dy)
    spread = 0.5 * share * square ** (1.0 / 3.0) + jitter * jitter
    logarithm = np.empty(len(z))
    for k in range(len(z)):
        wide, density = variance[k] + spread, 0.0
        for i in range(len(weights)):
            dx, dy = positions[i, 0] - z[k, 0], positions[i, 1] - z[k, 1]
            density += weights[i] * exp(-0.5 * (dx * dx + dy * dy) / wide)
        logarithm[k] = log(max(density / wide, 1e-30))
    return logarithm


@njit(cache=True)
def costs(
    positions: Array,
    weights: Array,
    z: Array,
    variance: Array,
    jitter: float,
    centre: Array,
    reach: float,
    anywhere: float,
) -> Array:
    """Minus twice the log likelihood of points, up to log(2 pi) (m,).

    Args:
        positions: as for `log_density`, like all up to `jitter`.
        weights: of the particles.
        z: points.
        variance: widening for each point.
        jitter: least width of a particle.
        centre: where the mover was seen last (2,) [m].
        reach: how far it may have got [m].
        anywhere: probability that it is anywhere in reach, not where the cloud is [1].
    """
    logarithm = log_density(positions, weights, z, variance, jitter)
    cost = np.empty(len(z))
    for k in range(len(z)):
        dx, dy = z[k, 0] - centre[0], z[k, 1] - centre[1]
        within = dx * dx + dy * dy < reach * reach
        spread = anywhere * 2.0 / (reach * reach) if within else 0.0
        cost[k] = -2.0 * log((1.0 - anywhere) * exp(logarithm[k]) + spread + 1e-30)
    return cost
