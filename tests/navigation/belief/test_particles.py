import numpy as np
import pytest

from compilation.record import record
from navigation.belief import particles
from navigation.belief.particles import moments
from navigation.belief.tracks import TURN_RATE, VX, WEIGHT
from navigation.parameters.belief import TrackingParameters

STATE = np.array([1.0, 2.0, 0.1, -0.05, 0.2])
COVARIANCE = np.diag([1e-4, 4e-4, 1e-4, 1e-4, 1e-4])
P = TrackingParameters()


def modes(still=0.0):
    """Goes on for sure, or stands still at (5, 5) with a probability."""
    states = np.stack([np.array([5.0, 5.0, 0.0, 0.0, 0.0]), STATE, STATE])
    standing = np.diag([1e-4, 1e-4, 0.0, 0.0, 0.0])
    weights = np.array([still, 1.0 - still, 0.0])
    return weights, states, np.stack([standing, COVARIANCE, COVARIANCE])


def cloud_of(positions, velocities, turn_rates, weights):
    return np.vstack([np.transpose(positions), np.transpose(velocities), turn_rates, weights])


def advance(cloud, dt, p, rng):
    count = cloud.shape[1]
    particles.advance(cloud, rng.standard_normal(count), rng.random(count), dt, record(p))


def straight(rate):
    """Movers that keep their line and turn back at a rate [1/s]."""
    return TrackingParameters(turn_rate_sigma=1e-9, reversal_rate=rate)


@pytest.fixture
def rng():
    return np.random.default_rng(0)


def test_particles_have_the_moments_of_the_filter(rng):
    cloud = particles.spawn(*modes(), 20000, rng)
    mean, covariance = moments(cloud)
    assert np.allclose(mean, STATE[:4], atol=1e-3)
    assert np.allclose(covariance, COVARIANCE[:4, :4], atol=2e-5)
    assert np.mean(cloud[TURN_RATE]) == pytest.approx(STATE[4], abs=1e-3)
    assert np.var(cloud[TURN_RATE]) == pytest.approx(COVARIANCE[4, 4], rel=0.1)
    assert cloud[WEIGHT].sum() == pytest.approx(1.0)


def test_particles_are_static_in_proportion_to_the_probability(rng):
    cloud = particles.spawn(*modes(still=0.5), 16, rng)
    standing = np.hypot(*cloud[VX:TURN_RATE]) < 1e-4
    assert standing.sum() == 8
    assert np.hypot(*(cloud[:VX, standing] - 5.0)).max() < 0.1


def test_refutation_is_bayes_rule():
    weights = np.array([0.1, 0.2, 0.3, 0.4])
    cloud = cloud_of(np.zeros((4, 2)), np.zeros((4, 2)), np.zeros(4), weights)
    expected = np.array([True, False, True, False])
    refuted, nothing, whole = cloud.copy(), cloud.copy(), cloud.copy()
    left = particles.refute(refuted, expected, 0.25)
    assert left == pytest.approx(0.25 * 0.4 + 0.6)
    assert np.allclose(refuted[WEIGHT], np.array([0.025, 0.2, 0.075, 0.4]) / left)
    assert particles.refute(nothing, np.zeros(4, bool), 0.25) == pytest.approx(1.0)
    assert np.allclose(nothing[WEIGHT], weights)
    assert particles.refute(whole, np.ones(4, bool), 0.0) == 0.0
    assert np.array_equal(whole[WEIGHT], weights)


def test_resampling_keeps_the_mean_and_only_happens_when_needed(rng):
    positions = rng.standard_normal((500, 2))
    even = cloud_of(positions, np.zeros((500, 2)), np.zeros(500), np.full(500, 1 / 500))
    assert particles.resample(even, P, rng) is even
    weights = np.where(positions[:, 0] > 1.0, 1.0, 1e-6)
    skewed = cloud_of(positions, np.zeros((500, 2)), np.zeros(500), weights / weights.sum())
    drawn = particles.resample(skewed, P, rng)
    assert np.allclose(drawn[WEIGHT], 1 / 500)
    before, _ = moments(skewed)
    after, _ = moments(drawn)
    assert np.allclose(after, before, atol=0.05)


def test_copies_of_one_particle_spread_by_the_jitter(rng):
    p = TrackingParameters(position_jitter=0.2, velocity_jitter=0.05)
    weights = np.zeros(4000)
    weights[7] = 1.0
    locations, velocities = rng.standard_normal((2, 4000, 2))
    drawn = particles.resample(
        cloud_of(locations, velocities, rng.standard_normal(4000), weights), p, rng
    )
    assert np.std(drawn[:VX].T - locations[7], axis=0) == pytest.approx(0.2, rel=0.1)
    assert np.std(drawn[VX:TURN_RATE].T - velocities[7], axis=0) == pytest.approx(0.05, rel=0.1)
    assert np.ptp(drawn[TURN_RATE]) == 0.0


def test_half_of_the_scattered_particles_fill_the_reach_and_half_the_line(rng):
    centre, velocity = np.array([1.0, -1.0]), np.array([0.0, 0.1])
    p = TrackingParameters(particles=2000, candidates_per_particle=4)
    cloud = particles.redistribute(centre, 0.5, velocity, p, rng)
    offsets = cloud[:VX].T - centre
    assert np.hypot(*offsets.T).max() < 0.5 + 5 * P.position_jitter
    assert np.allclose(np.hypot(*cloud[VX:TURN_RATE]), 0.1)
    line = np.abs(cloud[VX]) < 1e-9
    assert line.sum() == 4000
    assert np.std(offsets[line, 0]) == pytest.approx(P.position_jitter, rel=0.1)
    assert np.std(offsets[line, 1]) == pytest.approx(0.5 / np.sqrt(3), rel=0.1)
    assert np.mean(np.hypot(*offsets[~line].T) < 0.25) == pytest.approx(0.25, abs=0.03)


@pytest.fixture
def cloud():
    rng = np.random.default_rng(0)
    positions, velocities = rng.normal(0, 0.3, (16, 2)), rng.normal(0, 0.1, (16, 2))
    return cloud_of(positions, velocities, rng.normal(0, 0.2, 16), rng.dirichlet(np.ones(16)))


NEVER, ALWAYS = np.ones(16), np.zeros(16)


def test_only_drawn_particles_reverse(cloud):
    draws = np.linspace(0, 1, 16, endpoint=False)
    p = straight(-np.log(1.0 - 0.25) / 0.5)
    cloud[TURN_RATE] = 0.0
    before = cloud.copy()
    particles.advance(cloud, np.zeros(16), draws, 0.5, record(p))
    sign = np.where(draws < 0.25, -1.0, 1.0)
    assert cloud[VX:TURN_RATE] == pytest.approx(sign * before[VX:TURN_RATE])
    assert cloud[:VX] == pytest.approx(before[:VX] + 0.5 * sign * before[VX:TURN_RATE])
    assert np.array_equal(cloud[WEIGHT], before[WEIGHT])


def test_a_reversed_particle_returns_on_its_path(cloud):
    constant = record(TrackingParameters(turn_rate_sigma=1e-9, turn_rate_time=1e9))
    before = cloud.copy()
    particles.advance(cloud, np.zeros(16), NEVER, 0.1, constant)
    assert np.hypot(*cloud[VX:TURN_RATE]) == pytest.approx(np.hypot(*before[VX:TURN_RATE]))
    assert cloud[TURN_RATE] == pytest.approx(before[TURN_RATE])
    particles.advance(cloud, np.zeros(16), ALWAYS, 0.1, constant)
    assert cloud[:VX] == pytest.approx(before[:VX])
    assert cloud[VX:WEIGHT] == pytest.approx(-before[VX:WEIGHT])


def test_turn_rates_are_autocorrelated_noise(cloud):
    p, noise, before = TrackingParameters(turn_rate_time=1.0), cloud[VX].copy(), cloud.copy()
    particles.advance(cloud, noise, NEVER, 0.1, record(p))
    keep = np.exp(-0.1)
    wander = np.sqrt(1.0 - keep * keep) * p.turn_rate_sigma
    assert cloud[TURN_RATE] == pytest.approx(keep * before[TURN_RATE] + wander * noise)


def test_the_moments_are_those_of_weighted_samples(cloud):
    mean, covariance = moments(cloud)
    assert mean == pytest.approx(cloud[:4] @ cloud[WEIGHT])
    assert covariance == pytest.approx(np.cov(cloud[:4], aweights=cloud[WEIGHT], ddof=0))
    assert np.array_equal(covariance, covariance.T)


def test_the_likelihood_is_a_kernel_density_mixed_with_a_uniform_one(cloud):
    rng = np.random.default_rng(1)
    positions, weights = cloud[:VX].T, cloud[WEIGHT]
    z, variance = rng.normal(0, 0.3, (5, 2)), rng.uniform(1e-4, 1e-2, 5)
    off = positions - weights @ positions
    scott = 0.5 * (weights @ np.sum(off * off, axis=1)) * (weights @ weights) ** (1 / 3)
    wide = variance + scott + P.position_jitter**2
    square = np.sum((positions[:, None] - z) ** 2, axis=2)
    density = weights @ (np.exp(-0.5 * square / wide) / wide)
    reach, uniform = 0.4, P.uniform_probability
    flat = uniform * 2.0 / reach**2 * (np.hypot(*(z - z[0]).T) < reach)
    expected = -2.0 * np.log((1.0 - uniform) * density + flat)
    R = variance[:, None, None] * np.eye(2)
    assert particles.costs(cloud, z, R, z[0], reach, record(P)[0]) == pytest.approx(expected)
    assert 1 <= np.count_nonzero(flat) < 5
