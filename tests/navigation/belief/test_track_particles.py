from dataclasses import replace

import numpy as np
import pytest

from navigation.belief import particle_kernel, track_particles
from navigation.belief.belief import Particles
from navigation.belief.imm import Modes
from navigation.parameters.belief import TrackingParameters

STATE = np.array([1.0, 2.0, 0.1, -0.05, 0.2])
COVARIANCE = np.diag([1e-4, 4e-4, 1e-4, 1e-4, 1e-4])
P = TrackingParameters()
EACH = TrackingParameters(candidates_per_particle=1)  # one place for each particle


def modes(still=0.0):
    """Goes on for sure, or stands still at (5, 5) with a probability."""
    states = np.stack([np.array([5.0, 5.0, 0.0, 0.0, 0.0]), STATE, STATE])
    standing = np.diag([1e-4, 1e-4, 0.0, 0.0, 0.0])
    return Modes(
        np.array([still, 1.0 - still, 0.0]), states, np.stack([standing, COVARIANCE, COVARIANCE])
    )


def straight(rate):
    """Movers that keep their line and turn back at a rate [1/s]."""
    return TrackingParameters(turn_rate_sigma=1e-9, reversal_rate=rate)


def moments(cloud):
    return particle_kernel.moments(cloud.positions, cloud.velocities, cloud.weights)


@pytest.fixture
def rng():
    return np.random.default_rng(0)


def test_particles_have_the_moments_of_the_filter(rng):
    cloud = track_particles.spawn(modes(), 20000, rng)
    mean, covariance = moments(cloud)
    assert np.allclose(mean, STATE[:4], atol=1e-3)
    assert np.allclose(covariance, COVARIANCE[:4, :4], atol=2e-5)
    assert np.mean(cloud.turn_rates) == pytest.approx(STATE[4], abs=1e-3)
    assert np.var(cloud.turn_rates) == pytest.approx(COVARIANCE[4, 4], rel=0.1)
    assert cloud.weights.sum() == pytest.approx(1.0)


def test_particles_are_static_in_proportion_to_the_probability(rng):
    cloud = track_particles.spawn(modes(still=0.5), 16, rng)
    standing = np.hypot(*cloud.velocities.T) < 1e-4
    assert standing.sum() == 8
    assert np.hypot(*(cloud.positions[standing] - 5.0).T).max() < 0.1


def test_reversals_come_at_their_rate(rng):
    cloud = track_particles.spawn(modes(), 20000, rng)
    cloud = replace(cloud, turn_rates=np.zeros(20000))
    for _ in range(100):
        cloud = track_particles.advance(cloud, 0.05, straight(1.0 / 15.0), rng)
    # Expected sign after time t of a process that flips at a rate: exp(-2 rate t).
    assert np.mean(np.sign(cloud.velocities[:, 0])) == pytest.approx(np.exp(-2 * 5 / 15), abs=0.02)


def test_turn_rates_drift_about_zero_with_the_spread_of_movers(rng):
    p = TrackingParameters(turn_rate_sigma=0.3, turn_rate_time=1.0)
    cloud = track_particles.spawn(modes(), 20000, rng)
    for _ in range(50):
        cloud = track_particles.advance(cloud, 0.1, p, rng)
    assert np.mean(cloud.turn_rates) == pytest.approx(0.0, abs=0.01)
    assert np.std(cloud.turn_rates) == pytest.approx(0.3, rel=0.02)


def test_refutation_is_bayes_rule():
    cloud = Particles(
        np.zeros((4, 2)), np.zeros((4, 2)), np.zeros(4), np.array([0.1, 0.2, 0.3, 0.4])
    )
    expected = np.array([True, False, True, False])
    refuted, left = track_particles.refute(cloud, expected, 0.25)
    assert left == pytest.approx(0.25 * 0.4 + 0.6)
    assert np.allclose(refuted.weights, np.array([0.025, 0.2, 0.075, 0.4]) / left)
    nothing, whole = track_particles.refute(cloud, np.zeros(4, bool), 0.25)
    assert whole == pytest.approx(1.0)
    assert np.allclose(nothing.weights, cloud.weights)


def test_resampling_keeps_the_mean_and_only_happens_when_needed(rng):
    positions = rng.standard_normal((500, 2))
    even = Particles(positions, np.zeros((500, 2)), np.zeros(500), np.full(500, 1 / 500))
    assert track_particles.resample(even, P, rng) is even
    weights = np.where(positions[:, 0] > 1.0, 1.0, 1e-6)
    skewed = Particles(positions, np.zeros((500, 2)), np.zeros(500), weights / weights.sum())
    drawn = track_particles.resample(skewed, P, rng)
    assert np.allclose(drawn.weights, 1 / 500)
    before, _ = moments(skewed)
    after, _ = moments(drawn)
    assert np.allclose(after, before, atol=0.05)


def test_copies_of_one_particle_spread_by_the_jitter(rng):
    p = TrackingParameters(position_jitter=0.2, velocity_jitter=0.05)
    weights = np.zeros(4000)
    weights[7] = 1.0
    locations, velocities = rng.standard_normal((2, 4000, 2))
    drawn = track_particles.resample(
        Particles(locations, velocities, rng.standard_normal(4000), weights), p, rng
    )
    assert np.std(drawn.positions - locations[7], axis=0) == pytest.approx(0.2, rel=0.1)
    assert np.std(drawn.velocities - velocities[7], axis=0) == pytest.approx(0.05, rel=0.1)
    assert np.ptp(drawn.turn_rates) == 0.0


def test_half_of_the_scattered_particles_fill_the_reach_and_half_the_line(rng):
    centre, velocity = np.array([1.0, -1.0]), np.array([0.0, 0.1])
    p = TrackingParameters(particles=2000, candidates_per_particle=4)
    cloud = track_particles.redistribute(centre, 0.5, velocity, p, rng)
    offsets = cloud.positions - centre
    assert np.hypot(*offsets.T).max() < 0.5 + 5 * P.position_jitter
    assert np.allclose(np.hypot(*cloud.velocities.T), 0.1)
    line = np.abs(cloud.velocities[:, 0]) < 1e-9
    assert line.sum() == 4000
    assert np.std(offsets[line, 0]) == pytest.approx(P.position_jitter, rel=0.1)
    assert np.std(offsets[line, 1]) == pytest.approx(0.5 / np.sqrt(3), rel=0.1)
    assert np.mean(np.hypot(*offsets[~line].T) < 0.25) == pytest.approx(0.25, abs=0.03)


def test_the_density_has_no_holes_between_few_particles(rng):
    cloud = track_particles.redistribute(np.zeros(2), 1.0, np.array([0.1, 0.0]), EACH, rng)
    z = rng.uniform(-0.5, 0.5, (50, 2))
    jitter, variance = P.position_jitter, np.full(50, 1e-4)
    costs = particle_kernel.costs(
        cloud.positions, cloud.weights, z, variance, jitter, np.zeros(2), 1.0, 0.0
    )
    density = np.exp(-0.5 * costs) / (2 * np.pi)
    assert density.min() > 0.02
