"""Particles of a lost mover: where it may be while nobody looks.

A mover out of sight goes on, or turns back, so its whereabouts have several modes that
no Gaussian holds. A few particles walk on, reverse at a constant rate, lose weight
where the camera looks and finds nothing, and are redistributed over what it could have
reached when all of them are refuted.
"""

from math import exp

import numpy as np
from numpy.typing import NDArray

from navigation.belief import Particles
from navigation.visibility import Mask

Array = NDArray[np.float64]

POSITION_JITTER = 0.03
"""Spread of copies of one particle [m]."""
VELOCITY_JITTER = 0.01
"""Spread of their velocities [m/s]."""


def spawn(
    state: Array,
    covariance: Array,
    still: tuple[Array, Array] | None,
    count: int,
    rng: np.random.Generator,
) -> Particles:
    """Draw particles from the filters of a track.

    Args:
        state: x, y, vx, vy of the constant-velocity filter (4,).
        covariance: (4, 4).
        still: position and covariance of the static filter if the track may stand still;
            half of the particles then do.
        count: number of particles.
        rng: source of all draws.
    """
    root = np.linalg.cholesky(covariance + 1e-12 * np.eye(4))
    drawn = state + rng.standard_normal((count, 4)) @ root.T
    if still is not None:
        half = count // 2
        root = np.linalg.cholesky(still[1] + 1e-12 * np.eye(2))
        drawn[:half, :2] = still[0] + rng.standard_normal((half, 2)) @ root.T
        drawn[:half, 2:] = 0.0
    return Particles(drawn[:, :2].copy(), drawn[:, 2:].copy(), np.full(count, 1.0 / count))


def advance(cloud: Particles, dt: float, rate: float, rng: np.random.Generator) -> Particles:
    """Move on for `dt` [s], each particle turning back at `rate` [1/s]."""
    turned = rng.random(len(cloud.weights)) < 1.0 - exp(-rate * dt)
    velocities = np.where(turned[:, None], -cloud.velocities, cloud.velocities)
    return Particles(cloud.positions + dt * velocities, velocities, cloud.weights)


def refute(cloud: Particles, expected: Mask, survival: float) -> tuple[Particles, float]:
    """Weaken the particles that should have been detected but were not.

    Args:
        cloud: its weights sum to one.
        expected: whether each particle should have been detected (n,).
        survival: probability of missing one that should be.

    Returns:
        The particles with weights that sum to one, and the sum before: how well the
        whole cloud agrees with having seen nothing.
    """
    weights = np.where(expected, cloud.weights * survival, cloud.weights)
    total = float(weights.sum())
    if total <= 0.0:
        return cloud, 0.0
    return Particles(cloud.positions, cloud.velocities, weights / total), total


def resample(cloud: Particles, share: float, rng: np.random.Generator) -> Particles:
    """Systematic resampling with jitter once too few particles carry the weight.

    Args:
        cloud: particles.
        share: effective share of particles below which they are redrawn.
        rng: source of all draws.
    """
    count = len(cloud.weights)
    if float(cloud.weights @ cloud.weights) * share * count < 1.0:
        return cloud
    cumulative = np.cumsum(cloud.weights)
    ticks = (np.arange(count) + rng.random()) / count
    chosen = np.minimum(np.searchsorted(cumulative, ticks), count - 1)
    return Particles(
        cloud.positions[chosen] + POSITION_JITTER * rng.standard_normal((count, 2)),
        cloud.velocities[chosen] + VELOCITY_JITTER * rng.standard_normal((count, 2)),
        np.full(count, 1.0 / count),
    )


def scatter(
    centre: Array, radius: float, speed: float, count: int, rng: np.random.Generator
) -> Particles:
    """Particles anywhere in the disc a mover could have reached, walking anywhere.

    Args:
        centre: where it was last seen (2,) [m].
        radius: reach [m].
        speed: of the particles [m/s].
        count: number of particles.
        rng: source of all draws.
    """
    distance = radius * np.sqrt(rng.random(count))
    place = rng.uniform(-np.pi, np.pi, count)
    way = rng.uniform(-np.pi, np.pi, count)
    return Particles(
        centre + distance[:, None] * np.stack([np.cos(place), np.sin(place)], axis=1),
        speed * np.stack([np.cos(way), np.sin(way)], axis=1),
        np.full(count, 1.0 / count),
    )


def chosen(cloud: Particles, indices: NDArray[np.intp]) -> Particles:
    """The particles at `indices`, equally weighted."""
    count = len(indices)
    return Particles(
        cloud.positions[indices], cloud.velocities[indices], np.full(count, 1.0 / count)
    )


def moments(cloud: Particles) -> tuple[Array, Array]:
    """Mean (4,) and covariance (4, 4) of x, y, vx, vy over the particles."""
    values = np.concatenate([cloud.positions, cloud.velocities], axis=1)
    mean = cloud.weights @ values
    spread = values - mean
    covariance: Array = (spread.T * cloud.weights) @ spread
    return mean, 0.5 * (covariance + covariance.T)


def log_density(cloud: Particles, z: Array, variance: Array) -> Array:
    """Log density of the cloud, each particle widened, at points, up to log(2 pi).

    Args:
        cloud: n particles.
        z: points (m, 2) [m].
        variance: widening for each point (m,) [m²].

    Returns:
        (m,).
    """
    difference = cloud.positions[:, None, :] - z
    squared = np.sum(difference * difference, axis=2)
    density = cloud.weights @ (np.exp(-0.5 * squared / variance) / variance)
    log_density: Array = np.log(np.maximum(density, 1e-30))
    return log_density
