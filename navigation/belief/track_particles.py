"""Particle filter of a lost mover.

The position of a mover out of view is multimodal because it may reverse. The particles move
with random turn rates, reverse at a constant rate and lose weight where the camera sees empty
floor. When all are refuted, they are redistributed over the reachable area.
"""

from math import exp

import numpy as np
from numpy.typing import NDArray

from navigation.belief import particle_kernel
from navigation.belief.belief import Particles
from navigation.belief.imm import Modes
from navigation.belief.imm_kernel import SIZE
from navigation.belief.visibility import Mask
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]


def spawn(modes: Modes, count: int, rng: np.random.Generator) -> Particles:
    """Draw particles from the filters of one track.

    Args:
        modes: filters of the track.
        count: number of particles.
        rng: source of all draws.
    """
    mode = _systematic(modes.weights, count, rng)
    roots = np.linalg.cholesky(modes.covariances + 1e-12 * np.eye(SIZE))
    drawn = modes.states[mode]
    drawn = drawn + (roots[mode] @ rng.standard_normal((count, SIZE, 1)))[:, :, 0]
    position, velocity, turn = drawn[:, :2].copy(), drawn[:, 2:4].copy(), drawn[:, 4].copy()
    return Particles(position, velocity, turn, np.full(count, 1.0 / count))


def advance(
    cloud: Particles, dt: float, p: TrackingParameters, rng: np.random.Generator
) -> Particles:
    """Predict by `dt` [s], with random turn rates and reversals."""
    count, keep = len(cloud.weights), exp(-dt / p.turn_rate_time)
    parts = particle_kernel.advance(
        cloud.positions,
        cloud.velocities,
        cloud.turn_rates,
        rng.standard_normal(count),
        rng.random(count),
        (keep, (1.0 - keep * keep) ** 0.5 * p.turn_rate_sigma),
        1.0 - exp(-p.reversal_rate * dt),
        dt,
    )
    return Particles(*parts, cloud.weights)


def refute(cloud: Particles, expected: Mask, survival: float) -> tuple[Particles, float]:
    """Update the weights by a missed detection.

    Args:
        cloud: its weights sum to one.
        expected: whether each particle is in clear view (n,).
        survival: probability of missing a particle in clear view.

    Returns:
        The particles with normalized weights, and the likelihood of the missed detection.
    """
    weights = np.where(expected, cloud.weights * survival, cloud.weights)
    total = float(weights.sum())
    if total <= 0.0:
        return cloud, 0.0
    return Particles(cloud.positions, cloud.velocities, cloud.turn_rates, weights / total), total


def resample(cloud: Particles, p: TrackingParameters, rng: np.random.Generator) -> Particles:
    """Resample (systematic, with roughening) if the effective sample size is too small."""
    count = len(cloud.weights)
    if float(cloud.weights @ cloud.weights) * p.min_effective_fraction * count < 1.0:
        return cloud
    drawn = _systematic(cloud.weights, count, rng)
    return Particles(
        cloud.positions[drawn] + p.position_jitter * rng.standard_normal((count, 2)),
        cloud.velocities[drawn] + p.velocity_jitter * rng.standard_normal((count, 2)),
        cloud.turn_rates[drawn],
        np.full(count, 1.0 / count),
    )


def redistribute(
    centre: Array, radius: float, velocity: Array, p: TrackingParameters, rng: np.random.Generator
) -> Particles:
    """Draw candidates over the reachable disc: half along the last path, half uniformly.

    Args:
        centre: position of the last detection (2,) [m].
        radius: of the reachable disc [m].
        velocity: at the last detection (2,) [m/s].
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
    return Particles(centre + offsets[mixed], velocities[mixed], np.zeros(count), weights)


def select(cloud: Particles, indices: NDArray[np.intp]) -> Particles:
    """Return the particles at `indices`, equally weighted."""
    count = len(indices)
    return Particles(
        cloud.positions[indices],
        cloud.velocities[indices],
        cloud.turn_rates[indices],
        np.full(count, 1.0 / count),
    )


def _systematic(weights: Array, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return indices (count,) drawn by `weights` (n,) (systematic resampling)."""
    ticks = (np.arange(count) + rng.random()) / count
    return np.minimum(np.searchsorted(np.cumsum(weights), ticks), len(weights) - 1)
