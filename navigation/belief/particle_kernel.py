"""Compiled part of the particle filter of lost movers."""

from math import cos, exp, log, sin

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]


@compiled
def advance(
    positions: Array,
    velocities: Array,
    turn_rates: Array,
    noise: Array,
    draws: Array,
    wander: tuple[float, float],
    probability: float,
    dt: float,
) -> tuple[Array, Array, Array]:
    """Predict particles; those whose draw is below the probability reverse.

    Args:
        positions: (n, 2) [m].
        velocities: (n, 2) [m/s].
        turn_rates: (n,) [rad/s].
        noise: standard normal (n,).
        draws: uniform in [0, 1) (n,).
        wander: autocorrelation of the turn rate after dt [1], and its noise [rad/s].
        probability: of reversing [1].
        dt: [s].

    Returns:
        Positions, velocities and turn rates, new.
    """
    moved, turned = np.empty_like(positions), np.empty_like(velocities)
    rates = np.empty_like(turn_rates)
    for i in range(len(draws)):
        sign = -1.0 if draws[i] < probability else 1.0
        u, v = sign * velocities[i, 0], sign * velocities[i, 1]
        rate = sign * (wander[0] * turn_rates[i] + wander[1] * noise[i])
        angle = rate * dt
        # Midpoint rule.
        c, s = cos(0.5 * angle), sin(0.5 * angle)
        moved[i, 0] = positions[i, 0] + dt * (c * u - s * v)
        moved[i, 1] = positions[i, 1] + dt * (s * u + c * v)
        c, s = cos(angle), sin(angle)
        turned[i, 0], turned[i, 1], rates[i] = c * u - s * v, s * u + c * v, rate
    return moved, turned, rates


@compiled
def moments(positions: Array, velocities: Array, weights: Array) -> tuple[Array, Array]:
    """Return mean (4,) and covariance (4, 4) of x, y, vx, vy.

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


@compiled
def costs(
    positions: Array,
    weights: Array,
    z: Array,
    variance: Array,
    jitter: float,
    centre: Array,
    reach: float,
    uniform: float,
) -> Array:
    """Return the association costs of detections: -2 log likelihood, up to log(2 pi) (m,).

    The likelihood is a kernel density of the particles, mixed with a uniform density in the
    reachable disc. The kernel width follows Scott's rule, so that the density is positive
    between a few distant particles.

    Args:
        positions: of the particles (n, 2) [m].
        weights: sum to one (n,).
        z: detected positions (m, 2) [m].
        variance: of each detection (m,) [m²].
        jitter: minimum kernel width [m].
        centre: of the reachable disc (2,) [m].
        reach: its radius [m].
        uniform: weight of the uniform density [1].
    """
    x = y = square = scatter = 0.0
    for i in range(len(weights)):
        x += weights[i] * positions[i, 0]
        y += weights[i] * positions[i, 1]
        square += weights[i] * weights[i]
    for i in range(len(weights)):
        dx, dy = positions[i, 0] - x, positions[i, 1] - y
        scatter += weights[i] * (dx * dx + dy * dy)
    spread = 0.5 * scatter * square ** (1.0 / 3.0) + jitter * jitter
    cost = np.empty(len(z))
    for k in range(len(z)):
        wide, density = variance[k] + spread, 0.0
        for i in range(len(weights)):
            dx, dy = positions[i, 0] - z[k, 0], positions[i, 1] - z[k, 1]
            density += weights[i] * exp(-0.5 * (dx * dx + dy * dy) / wide)
        logarithm = log(max(density / wide, 1e-30))
        dx, dy = z[k, 0] - centre[0], z[k, 1] - centre[1]
        within = dx * dx + dy * dy < reach * reach
        flat = uniform * 2.0 / (reach * reach) if within else 0.0
        cost[k] = -2.0 * log((1.0 - uniform) * exp(logarithm) + flat + 1e-30)
    return cost
