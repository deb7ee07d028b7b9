from dataclasses import replace
from math import exp, inf

import numpy as np
import pytest

from navigation.belief.detections import given_radius, in_world, variance_inflation
from navigation.transform import to_world


def convert(observations, pose, P, **changes):
    options = {"max_pose_sigma": 10.0} | changes
    return in_world(observations, np.array(pose), P, **options)


def test_covariance_is_the_first_order_propagation(observe):
    rng = np.random.default_rng(0)
    for _ in range(20):
        pose = rng.uniform(-3, 3, 3)
        position = tuple((pose[:2] + rng.uniform(0.5, 2, 2)).tolist())
        A = rng.standard_normal((3, 3)) * 0.02
        P = A @ A.T
        o = observe(pose.tolist(), position, sigma=(0.05, 0.02))
        observed = convert([o], pose, P)
        assert np.allclose(observed.rows[0].position, position)

        def f(v, o=o):
            return np.array(to_world(v[:3], o.distance + v[3], o.bearing + v[4]))

        v, h = np.concatenate([pose, [0.0, 0.0]]), 1e-6
        J = np.stack([(f(v + h * e) - f(v - h * e)) / (2 * h) for e in np.eye(5)], axis=1)
        whole = np.zeros((5, 5))
        whole[:3, :3], whole[3:, 3:] = P, o.covariance
        assert np.allclose(observed.rows[0].covariance, J @ whole @ J.T, atol=1e-8)


def test_a_radius_known_otherwise_is_conditioning_on_it(observe):
    """By sampling: place and radius are drawn together, and those with that radius chosen."""
    rng = np.random.default_rng(1)
    pose, position = (0.5, -0.2, 0.7), (1.1, 0.4)
    o = observe(pose, position, sigma=(0.02, 0.02), radius=0.085, radius_sigma=0.02)
    slope = np.array([0.4, -0.7])
    joint = np.zeros((3, 3))
    joint[:2, :2] = o.covariance + 0.02**2 * np.outer(slope, slope)
    joint[:2, 2] = joint[2, :2] = slope * 0.02**2
    joint[2, 2] = 0.02**2
    observed = convert(
        [replace(o, covariance=joint[:2, :2], by_radius=slope)], pose, np.zeros((3, 3))
    )
    drawn = rng.multivariate_normal([o.distance, o.bearing, o.radius], joint, 400_000)
    chosen = drawn[np.abs(drawn[:, 2] - 0.06) < 5e-4]
    points = np.array([to_world(np.array(pose), d, b) for d, b, _ in chosen])
    moved, covariance = given_radius(observed.rows[0], 0.06, 0.0)
    assert moved == pytest.approx(points.mean(axis=0), abs=2e-3)
    assert covariance == pytest.approx(np.cov(points.T), abs=5e-5)
    same, whole = given_radius(observed.rows[0], o.radius, o.radius_sigma)
    assert np.array_equal(same, observed.rows[0].position)
    assert whole == pytest.approx(observed.rows[0].covariance)


def test_a_lost_pose_does_not_drown_the_tracks(observe):
    pose = (0.0, 0.0, 0.4)
    P = np.diag([1.0, 0.5, 1.0])
    limited = convert([observe(pose, (1.0, 0.2))], pose, P, max_pose_sigma=0.1)
    same = convert([observe(pose, (1.0, 0.2))], pose, 0.01 * P)
    assert np.allclose(limited.rows["covariance"], same.rows["covariance"])


def test_beacons_are_no_obstacles(observe):
    observed = convert([observe((0, 0, 0), (1.0, 0.0), kind="beacon")], (0.0, 0.0, 0.0), np.eye(3))
    assert observed.labels == ()
    assert observed.positions.shape == (0, 2)
    assert observed.radii.shape == (0,)


def test_independent_measurements_keep_their_variance():
    assert variance_inflation(0.06, 0.0) == 1.0
    assert variance_inflation(inf, 0.1) == 1.0
    assert variance_inflation(5.0, 0.1) == pytest.approx(1.0)


def test_is_the_variance_of_a_mean_of_autocorrelated_noise():
    dt, tau, n = 0.06, 0.1, 4000
    a = exp(-dt / tau)
    lags = np.arange(1, n)
    variance_of_mean = (1 + 2 * np.sum((1 - lags / n) * a**lags)) / n
    assert variance_inflation(dt, tau) / n == pytest.approx(variance_of_mean, rel=2e-3)
