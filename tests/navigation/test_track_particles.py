import numpy as np
import pytest

from navigation import track_particles
from navigation.belief import Particles

STATE = np.array([1.0, 2.0, 0.1, -0.05])
COVARIANCE = np.diag([1e-4, 4e-4, 1e-4, 1e-4])


@pytest.fixture
def rng():
    return np.random.default_rng(0)


def test_particles_have_the_moments_of_the_filter(rng):
    cloud = track_particles.spawn(STATE, COVARIANCE, None, 20000, rng)
    mean, covariance = track_particles.moments(cloud)
    assert np.allclose(mean, STATE, atol=1e-3)
    assert np.allclose(covariance, COVARIANCE, atol=2e-5)
    assert cloud.weights.sum() == pytest.approx(1.0)


def test_half_stand_still_if_the_track_may(rng):
    still = (np.array([5.0, 5.0]), np.eye(2) * 1e-4)
    cloud = track_particles.spawn(STATE, COVARIANCE, still, 16, rng)
    standing = np.all(cloud.velocities == 0.0, axis=1)
    assert standing.sum() == 8
    assert np.hypot(*(cloud.positions[standing] - 5.0).T).max() < 0.1


def test_reversals_come_at_their_rate(rng):
    cloud = track_particles.spawn(STATE, COVARIANCE, None, 20000, rng)
    for _ in range(100):
        cloud = track_particles.advance(cloud, 0.05, 1.0 / 15.0, rng)
    # Expected sign after time t of a process that flips at a rate: exp(-2 rate t).
    assert np.mean(np.sign(cloud.velocities[:, 0])) == pytest.approx(np.exp(-2 * 5 / 15), abs=0.02)


def test_without_reversals_particles_go_straight(rng):
    cloud = track_particles.spawn(STATE, COVARIANCE, None, 10, rng)
    later = track_particles.advance(cloud, 2.0, 0.0, rng)
    assert np.allclose(later.positions, cloud.positions + 2.0 * cloud.velocities)


def test_refutation_is_bayes_rule():
    cloud = Particles(np.zeros((4, 2)), np.zeros((4, 2)), np.array([0.1, 0.2, 0.3, 0.4]))
    expected = np.array([True, False, True, False])
    refuted, left = track_particles.refute(cloud, expected, 0.25)
    assert left == pytest.approx(0.25 * 0.4 + 0.6)
    assert np.allclose(refuted.weights, np.array([0.025, 0.2, 0.075, 0.4]) / left)
    nothing, whole = track_particles.refute(cloud, np.zeros(4, bool), 0.25)
    assert whole == pytest.approx(1.0)
    assert np.allclose(nothing.weights, cloud.weights)


def test_resampling_keeps_the_mean_and_only_happens_when_needed(rng):
    positions = rng.standard_normal((500, 2))
    even = Particles(positions, np.zeros((500, 2)), np.full(500, 1 / 500))
    assert track_particles.resample(even, 0.35, rng) is even
    weights = np.where(positions[:, 0] > 1.0, 1.0, 1e-6)
    skewed = Particles(positions, np.zeros((500, 2)), weights / weights.sum())
    drawn = track_particles.resample(skewed, 0.35, rng)
    assert np.allclose(drawn.weights, 1 / 500)
    before, _ = track_particles.moments(skewed)
    after, _ = track_particles.moments(drawn)
    assert np.allclose(after, before, atol=0.05)


def test_scattered_particles_fill_the_reach(rng):
    centre = np.array([1.0, -1.0])
    cloud = track_particles.scatter(centre, 0.5, 0.1, 4000, rng)
    distance = np.hypot(*(cloud.positions - centre).T)
    assert distance.max() <= 0.5
    assert np.mean(distance < 0.25) == pytest.approx(0.25, abs=0.03)
    assert np.allclose(np.hypot(*cloud.velocities.T), 0.1)


def test_log_density_of_one_particle_is_a_gaussian():
    cloud = Particles(np.array([[1.0, 0.0]]), np.zeros((1, 2)), np.ones(1))
    z = np.array([[1.0, 0.0], [1.2, 0.1]])
    variance = np.array([0.01, 0.04])
    squared = np.array([0.0, 0.05])
    expected = -0.5 * squared / variance - np.log(variance)
    assert np.allclose(track_particles.log_density(cloud, z, variance), expected)


def test_chosen_particles_weigh_the_same(rng):
    cloud = track_particles.scatter(np.zeros(2), 1.0, 0.1, 8, rng)
    few = track_particles.chosen(cloud, np.array([1, 5]))
    assert np.array_equal(few.positions, cloud.positions[[1, 5]])
    assert few.weights.tolist() == [0.5, 0.5]
