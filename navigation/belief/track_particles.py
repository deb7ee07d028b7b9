"""Particles of a lost mover: where it may be while nobody looks.

A mover out of sight goes on, or turns back, so its whereabouts have several modes that
no Gaussian holds. A few particles walk on in bends, reverse at a constant rate, lose weight
where the camera looks and finds nothing, and are redistributed over what it could have
reached when all of them are refuted.
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
        modes: filters of standing still, going on and having turned back.
        count: number of particles.
        rng: source of all draws.
    """
    mode = _systematic(modes.weights, count, rng)
    roots = np.linalg.cholesky(modes.covariances + 1e-12 * np.eye(SIZE))
    drawn = modes.states[mode]
    drawn = drawn + (roots[mode] @ rng.standard_normal((count, SIZE, 1)))[:, :, 0]
    place, velocity, turn = drawn[:, :2].copy(), drawn[:, 2:4].copy(), drawn[:, 4].copy()
    return Particles(place, velocity, turn, np.full(count, 1.0 / count))


def advance(
    cloud: Particles, dt: float, p: TrackingParameters, rng: np.random.Generator
) -> Particles:
    """Move on for `dt` [s], bending and turning back as movers do."""
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
    return Particles(cloud.positions, cloud.velocities, cloud.turn_rates, weights / total), total


def resample(cloud: Particles, p: TrackingParameters, rng: np.random.Generator) -> Particles:
    """Systematic resampling with jitter once too few particles carry the weight."""
    count = len(cloud.weights)
    if float(cloud.weights @ cloud.weights) * p.min_effective_fraction * count < 1.0:
        return cloud
    chosen = _systematic(cloud.weights, count, rng)
    return Particles(
        cloud.positions[chosen] + p.position_jitter * rng.standard_normal((count, 2)),
        cloud.velocities[chosen] + p.velocity_jitter * rng.standard_normal((count, 2)),
        cloud.turn_rates[chosen],
        np.full(count, 1.0 / count),
    )


def scatter(
    centre: Array, radius: float, velocity: Array, p: TrackingParameters, rng: np.random.Generator
) -> Particles:
    """Particles wherever a mover could have got to: half on its old line, half anywhere.

    Args:
        centre: where it was last seen (2,) [m].
        radius: reach [m].
        velocity: with which it was last seen (2,) [m/s].
        p: how many places are tried for how many particles, and the width of the line.
        rng: source of all draws.
    """
    count = p.candidates_per_particle * p.particles
    half = count // 2
    speed = float(np.hypot(velocity[0], velocity[1]))
    ahead = velocity / speed if speed > 0.0 else np.array([1.0, 0.0])
    distance = radius * np.sqrt(rng.random(count))
    place = rng.uniform(-np.pi, np.pi, count)
    way = rng.uniform(-np.pi, np.pi, count)
    offsets = distance[:, None] * np.stack([np.cos(place), np.sin(place)], axis=1)
    velocities = speed * np.stack([np.cos(way), np.sin(way)], axis=1)
    along = rng.uniform(-radius, radius, half)
    offsets[:half] = along[:, None] * ahead + p.position_jitter * rng.standard_normal((half, 2))
    velocities[:half] = np.where(rng.random(half) < 0.5, 1.0, -1.0)[:, None] * velocity
    mixed = rng.permutation(count)
    places, even = centre + offsets[mixed], np.full(count, 1.0 / count)
    return Particles(places, velocities[mixed], np.zeros(count), even)


def chosen(cloud: Particles, indices: NDArray[np.intp]) -> Particles:
    """The particles at `indices`, equally weighted."""
    count = len(indices)
    return Particles(
        cloud.positions[indices],
        cloud.velocities[indices],
        cloud.turn_rates[indices],
        np.full(count, 1.0 / count),
    )


def moments(cloud: Particles) -> tuple[Array, Array]:
    """Mean (4,) and covariance (4, 4) of x, y, vx, vy over the particles."""
    return particle_kernel.moments(cloud.positions, cloud.velocities, cloud.weights)


def costs(
    cloud: Particles,
    z: Array,
    variance: Array,
    lost: tuple[Array, float],
    p: TrackingParameters,
) -> Array:
    """Minus twice the log likelihood of sightings, up to log(2 pi) (m,).

    Args:
        cloud: n particles.
        z: sightings (m, 2) [m].
        variance: of each (m,) [m²].
        lost: where it was seen last (2,) [m], and how far it may have got [m].
        p: how probable it is that it is anywhere so far, not where the particles are.
    """
    return particle_kernel.costs(
        cloud.positions, cloud.weights, z, variance, p.position_jitter, *lost, p.uniform_probability
    )


def _systematic(weights: Array, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Indices (count,) drawn by `weights` (n,) from one draw: as many of each as its share."""
    ticks = (np.arange(count) + rng.random()) / count
    return np.minimum(np.searchsorted(np.cumsum(weights), ticks), len(weights) - 1)
