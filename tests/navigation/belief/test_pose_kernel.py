"""Compiled against plain Python, and against filterpy and the formulas over arrays."""

import numpy as np
import pytest
from filterpy.kalman import JulierSigmaPoints, unscented_transform

from navigation.angles import wrap, wrap_array
from navigation.belief import pose_kernel as kernel
from navigation.transform import range_bearing


@pytest.fixture
def drawn():
    """Sigma points of a random pose, weights, landmarks, sightings and their noise."""
    rng = np.random.default_rng(0)
    A = 0.1 * rng.standard_normal((3, 3))
    P, pose = A @ A.T + 1e-3 * np.eye(3), np.array([0.4, -1.0, 3.1])
    julier = JulierSigmaPoints(3, kappa=0.0)
    landmarks = rng.uniform(-3, 3, (3, 2))
    z = np.array([range_bearing(pose + 0.02, tuple(p)) for p in landmarks.tolist()])
    noise = np.array([np.diag([1e-3, 1e-4])] * 3)
    return pose, P, julier.sigma_points(pose, P), julier.Wm, julier.Wc, landmarks, z, noise


def same(a, b):
    pairs = zip(a, b, strict=True) if isinstance(a, tuple) else [(a, b)]
    return all(np.allclose(p, q, rtol=1e-12, atol=1e-13) for p, q in pairs)


def test_compiled_and_plain_agree(drawn):
    pose, P, points, mean_weights, weights, landmarks, z, noise = drawn
    seen = np.array([kernel.sighted(p, landmarks) for p in points])
    step = np.array([0.1, -0.02, 0.2])
    for function, arguments in (
        (kernel.root, (P,)),
        (kernel.sigma_points, (pose, P)),
        (kernel.moved, (points, step)),
        (kernel.sighted, (pose, landmarks)),
        (kernel.difference, (seen[1], seen[2], 2)),
        (kernel.transform, (points, mean_weights, weights, P, 3)),
        (kernel.cross_covariance, (points, pose, seen, seen[0], weights, 2)),
        (kernel.nis, (points, mean_weights, weights, landmarks, z, noise)),
        (kernel.together, (noise, 2e-5, 0.9)),
    ):
        assert same(function(*arguments), function.py_func(*arguments))


@pytest.mark.parametrize("angle", [0.0, np.pi, -np.pi, 3.2, -9.5, 40.0])
def test_wrapping_is_that_of_angles(angle):
    assert kernel.wrapped(angle) == pytest.approx(wrap(angle), abs=1e-12)
    assert -np.pi < kernel.wrapped(angle) <= np.pi


def test_points_and_root_are_those_of_filterpy(drawn):
    pose, P, points, *_ = drawn
    assert kernel.root(P) == pytest.approx(np.linalg.cholesky(P).T)
    assert kernel.sigma_points(pose, kernel.root(3.0 * P)) == pytest.approx(points)
    assert not kernel.root(np.diag([1.0, -1.0, 1.0])).any()
    assert not kernel.root(np.full((2, 2), np.nan)).any()


def test_the_transform_is_filterpys_with_angles(drawn):
    _, P, points, mean_weights, weights, *_ = drawn
    centre, covariance = kernel.transform(points, mean_weights, weights, P, 3)
    turn = np.arctan2(mean_weights @ np.sin(points[:, 2]), mean_weights @ np.cos(points[:, 2]))

    def mean(p, w):
        return np.array([*(w @ p[:, :2]), turn])

    def residual(a, b):
        return np.array([*(a - b)[:2], wrap(a[2] - b[2])])

    wanted = unscented_transform(points, mean_weights, weights, P, mean, residual)
    assert centre == pytest.approx(wanted[0])
    assert covariance == pytest.approx(wanted[1])


def test_a_landmark_is_seen_as_from_everywhere_else(drawn):
    pose, _, _, _, _, landmarks, *_ = drawn
    wanted = [v for p in landmarks.tolist() for v in range_bearing(pose.tolist(), tuple(p))]
    assert kernel.sighted(pose, landmarks) == pytest.approx(wanted)


def test_the_distance_is_that_of_the_innovation(drawn):
    _, _, points, mean_weights, weights, landmarks, z, noise = drawn
    found = kernel.nis(points, mean_weights, weights, landmarks, z, noise)
    for i in range(3):
        seen = np.array([kernel.sighted(p, landmarks[i : i + 1]) for p in points])
        centre, S = kernel.transform(seen, mean_weights, weights, noise[i], 2)
        y = z[i] - centre
        y[1] = wrap(y[1])
        assert found[i] == pytest.approx(y @ np.linalg.solve(S, y))


def test_the_cross_covariance_is_the_weighted_sum_of_outer_products(drawn):
    pose, _, points, _, weights, landmarks, *_ = drawn
    seen = np.array([kernel.sighted(p, landmarks) for p in points])
    dx, dz = points - pose, seen - seen[0]
    dx[:, 2] = wrap_array(dx[:, 2])
    dz[:, 1::2] = wrap_array(dz[:, 1::2])
    wanted = np.einsum("k,ki,kj->ij", weights, dx, dz)
    assert kernel.cross_covariance(points, pose, seen, seen[0], weights, 2) == pytest.approx(wanted)


@pytest.mark.parametrize(("shared", "common"), [(2e-5, 2e-5), (1.0, 0.9e-4)])
def test_bearings_have_one_error_in_common_and_are_no_surer_for_it(shared, common):
    A = np.random.default_rng(1).standard_normal((3, 2, 2))
    noise = 1e-3 * A @ np.swapaxes(A, 1, 2)
    noise[:, 1, 1] = 3e-4, 1e-4, 2e-4
    noise[:, 0, 0] = 1.0
    found = kernel.together(noise, shared, 0.9)
    wanted = np.kron(np.ones((3, 3)), np.diag([0.0, common]))
    for i in range(3):
        wanted[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = noise[i]
    assert np.array_equal(found, wanted)
    assert np.linalg.eigvalsh(found).min() > 0.0
