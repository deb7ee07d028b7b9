"""Particle filter of a lost mover.

The position of a mover out of view is multimodal because it may reverse. The particles move
with random turn rates, reverse at a constant rate and lose weight where the camera sees empty
floor. When all are refuted, they are redistributed over the reachable area. A cloud of m particles
is an array of x, y, vx, vy, turn rate and weight (6, m); the weights sum to one.
"""

from math import cos, exp, log, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from navigation.belief.mode_filter import SIZE
from navigation.belief.tracks import TURN_RATE, VX, VY, WEIGHT, X, Y
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]
Rows = NDArray[np.record]
Mask = NDArray[np.bool_]


def spawn(
    weights: Array, states: Array, covariances: Array, count: int, rng: np.random.Generator
) -> Array:
    """Draw particles from the filters of one track (6, count).

    Args:
        weights: probabilities of the modes (3,).
        states: states of the modes (3, 5).
        covariances: their covariances (3, 5, 5).
        count: number of particles.
        rng: source of all draws.
    """
    mode = _systematic(weights, count, rng)
    roots = np.linalg.cholesky(covariances + 1e-12 * np.eye(SIZE))
    drawn = states[mode] + (roots[mode] @ rng.standard_normal((count, SIZE, 1)))[:, :, 0]
    return np.vstack([drawn.T, np.full(count, 1.0 / count)])


@compiled
def advance(cloud: Array, noise: Array, draws: Array, dt: float, parameters: Rows) -> None:
    """Predict particles by `dt` [s] in place, with random turn rates and reversals.

    Args:
        cloud: particles (6, m).
        noise: standard normal (m,).
        draws: uniform in [0, 1) (m,).
        dt: time [s].
        parameters: record of the parameters of tracking (1,).
    """
    p = parameters[0]
    keep, probability = exp(-dt / p.turn_rate_time), 1.0 - exp(-p.reversal_rate * dt)
    wander = sqrt(1.0 - keep * keep) * p.turn_rate_sigma
    for i in range(len(draws)):
        sign = -1.0 if draws[i] < probability else 1.0
        u, v = sign * cloud[VX, i], sign * cloud[VY, i]
        rate = sign * (keep * cloud[TURN_RATE, i] + wander * noise[i])
        angle = rate * dt
        # Midpoint rule.
        c, s = cos(0.5 * angle), sin(0.5 * angle)
        cloud[X, i] += dt * (c * u - s * v)
        cloud[Y, i] += dt * (s * u + c * v)
        c, s = cos(angle), sin(angle)
        cloud[VX, i], cloud[VY, i], cloud[TURN_RATE, i] = c * u - s * v, s * u + c * v, rate


@compiled
def refute(cloud: Array, expected: Mask, survival: float) -> float:
    """Update the weights by a missed detection; return its likelihood [1].

    Args:
        cloud: particles (6, m).
        expected: whether each particle is in clear view (m,).
        survival: probability of missing a particle in clear view [1].
    """
    total = 0.0
    for i in range(len(expected)):
        total += cloud[WEIGHT, i] * (survival if expected[i] else 1.0)
    if total <= 0.0:
        return 0.0
    for i in range(len(expected)):
        cloud[WEIGHT, i] *= (survival if expected[i] else 1.0) / total
    return total


def resample(cloud: Array, p: TrackingParameters, rng: np.random.Generator) -> Array:
    """Resample (systematic, with roughening) if the effective sample size is too small."""
    weights, count = cloud[WEIGHT], cloud.shape[1]
    if float(weights @ weights) * p.min_effective_fraction * count < 1.0:
        return cloud
    drawn = cloud[:, _systematic(weights, count, rng)]
    drawn[X : Y + 1] += p.position_jitter * rng.standard_normal((count, 2)).T
    drawn[VX : VY + 1] += p.velocity_jitter * rng.standard_normal((count, 2)).T
    drawn[WEIGHT] = 1.0 / count
    return drawn


def redistribute(
    centre: Array, radius: float, velocity: Array, p: TrackingParameters, rng: np.random.Generator
) -> Array:
    """Draw candidates over the reachable disc: half along the last path, half uniformly (6, m).

    Args:
        centre: position of the last detection (2,) [m].
        radius: radius of the reachable disc [m].
        velocity: velocity at the last detection (2,) [m/s].
        p: numbers of particles and of candidates per particle, width of the path.
        rng: source of all draws.
    """
    count = p.candidates_per_particle * p.particles
    half = count // 2
    speed = float(np.hypot(velocity[0], velocity[1]))
    ahead = velocity / speed if speed > 0.0 else np.array([1.0, 0.0])
    distance = radius * np.sqrt(rng.random(count))
    azimuth = rng.uniform(-np.pi, np.pi, count)
    course = rng.uniform(-np.pi, np.pi, count)
    offsets = distance[:, None] * np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1)
    velocities = speed * np.stack([np.cos(course), np.sin(course)], axis=1)
    along = rng.uniform(-radius, radius, half)
    offsets[:half] = along[:, None] * ahead + p.position_jitter * rng.standard_normal((half, 2))
    velocities[:half] = np.where(rng.random(half) < 0.5, 1.0, -1.0)[:, None] * velocity
    mixed = rng.permutation(count)
    weights = np.full(count, 1.0 / count)
    return np.vstack([(centre + offsets[mixed]).T, velocities[mixed].T, np.zeros(count), weights])


@compiled
def moments(cloud: Array) -> tuple[Array, Array]:
    """Return mean (4,) and covariance (4, 4) of x, y, vx, vy of particles (6, m)."""
    mean, covariance = np.zeros(4), np.zeros((4, 4))
    for i in range(cloud.shape[1]):
        for a in range(4):
            mean[a] += cloud[WEIGHT, i] * cloud[a, i]
    for i in range(cloud.shape[1]):
        for a in range(4):
            for b in range(4):
                product = (cloud[a, i] - mean[a]) * (cloud[b, i] - mean[b])
                covariance[a, b] += cloud[WEIGHT, i] * product
    return mean, covariance


@compiled
def costs(cloud: Array, z: Array, R: Array, centre: Array, reach: float, p: np.record) -> Array:
    """Return the association costs of detections: -2 log likelihood, up to log(2 pi) (m,).

    The likelihood is a kernel density of the particles, mixed with a uniform density in the
    reachable disc. The kernel width follows Scott's rule, so that the density is positive
    between a few distant particles.

    Args:
        cloud: particles (6, n).
        z: detected positions (m, 2) [m].
        R: their covariances (m, 2, 2) [m²].
        centre: centre of the reachable disc (2,) [m].
        reach: radius of the disc [m].
        p: parameters of tracking.
    """
    n, uniform = cloud.shape[1], p.uniform_probability
    x = y = square = scatter = 0.0
    for i in range(n):
        weight = cloud[WEIGHT, i]
        x += weight * cloud[X, i]
        y += weight * cloud[Y, i]
        square += weight * weight
    for i in range(n):
        dx, dy = cloud[X, i] - x, cloud[Y, i] - y
        scatter += cloud[WEIGHT, i] * (dx * dx + dy * dy)
    jitter = p.position_jitter
    spread = 0.5 * scatter * square ** (1.0 / 3.0) + jitter * jitter
    cost = np.empty(len(z))
    for k in range(len(z)):
        wide, density = 0.5 * (R[k, 0, 0] + R[k, 1, 1]) + spread, 0.0
        for i in range(n):
            dx, dy = cloud[X, i] - z[k, 0], cloud[Y, i] - z[k, 1]
            density += cloud[WEIGHT, i] * exp(-0.5 * (dx * dx + dy * dy) / wide)
        logarithm = log(max(density / wide, 1e-30))
        dx, dy = z[k, 0] - centre[0], z[k, 1] - centre[1]
        within = dx * dx + dy * dy < reach * reach
        flat = uniform * 2.0 / (reach * reach) if within else 0.0
        cost[k] = -2.0 * log((1.0 - uniform) * exp(logarithm) + flat + 1e-30)
    return cost


def _systematic(weights: Array, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return indices (count,) drawn by `weights` (n,) (systematic resampling)."""
    ticks = (np.arange(count) + rng.random()) / count
    return np.minimum(np.searchsorted(np.cumsum(weights), ticks), len(weights) - 1)
