import numpy as np
from filterpy.kalman import KalmanFilter
from scipy.stats import multivariate_normal

from navigation import track_filter


def random_covariances(rng, n, k):
    A = rng.standard_normal((n, k, k))
    return A @ np.swapaxes(A, 1, 2) * 1e-3 + 1e-5 * np.eye(k)


def test_equals_filterpys_kalman_filter():
    rng = np.random.default_rng(0)
    n, dt, q = 5, 0.06, 0.03
    x, P = rng.standard_normal((n, 4)), random_covariances(rng, n, 4)
    reference = []
    for i in range(n):
        kf = KalmanFilter(dim_x=4, dim_z=2)
        kf.x, kf.P = x[i].copy(), P[i].copy()
        kf.F = np.eye(4) + dt * np.eye(4, k=2)
        kf.H = np.eye(2, 4)
        block = np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]) * q * q
        kf.Q = np.kron(block, np.eye(2))
        reference.append(kf)
    for _ in range(30):
        x, P = track_filter.predict_moving(x, P, dt, q)
        z, R = rng.standard_normal((n, 2)), random_covariances(rng, n, 2)
        seen = track_filter.innovation(x[:, :2], P[:, :2, :2], z, R)
        x, P = track_filter.update(x, P, R, seen)
        for i, kf in enumerate(reference):
            kf.predict()
            kf.update(z[i], R=R[i])
            assert np.allclose(x[i], kf.x, atol=1e-12)
            assert np.allclose(P[i], kf.P, atol=1e-12)
            assert np.isclose(seen.distance[i], kf.mahalanobis**2, rtol=1e-9)


def test_covariance_stays_positive_definite_through_gaps_and_looks():
    rng = np.random.default_rng(1)
    x, P = np.zeros((1, 4)), np.diag([1e-4, 1e-4, 4e-3, 4e-3])[None]
    R = np.diag([1e-6, 1e-2])[None]
    for _ in range(5000):
        dt = float(rng.choice([0.06, 0.06, 20.0]))
        x, P = track_filter.predict_moving(x, P, dt, 0.03)
        seen = track_filter.innovation(x[:, :2], P[:, :2, :2], rng.normal(0, 0.1, (1, 2)), R)
        x, P = track_filter.update(x, P, R, seen)
        assert np.linalg.eigvalsh(P[0])[0] > 0
        assert np.array_equal(P, np.swapaxes(P, 1, 2))


def test_predictions_add_up():
    rng = np.random.default_rng(2)
    x, P = rng.standard_normal((3, 4)), random_covariances(rng, 3, 4)
    once = track_filter.predict_moving(x, P, 1.0, 0.03)
    twice = track_filter.predict_moving(*track_filter.predict_moving(x, P, 0.4, 0.03), 0.6, 0.03)
    assert np.allclose(once[0], twice[0])
    assert np.allclose(once[1], twice[1])


def test_innovation_broadcasts_tracks_against_sightings():
    rng = np.random.default_rng(3)
    x, P = rng.standard_normal((3, 2)), random_covariances(rng, 3, 2)
    z, R = rng.standard_normal((4, 2)), random_covariances(rng, 4, 2)
    pairs = track_filter.innovation(x[:, None], P[:, None], z[None], R[None])
    for i in range(3):
        for j in range(4):
            S, y = P[i] + R[j], z[j] - x[i]
            assert np.isclose(pairs.distance[i, j], y @ np.linalg.solve(S, y))
            assert np.isclose(pairs.log_det[i, j], np.log(np.linalg.det(S)))


def test_the_log_likelihood_is_that_of_the_gaussian_up_to_its_constant():
    rng = np.random.default_rng(4)
    x, P = rng.standard_normal((6, 2)), random_covariances(rng, 6, 2)
    z, R = x + 0.05 * rng.standard_normal((6, 2)), random_covariances(rng, 6, 2)
    seen = track_filter.innovation(x, P, z, R)
    exact = [multivariate_normal(x[i], P[i] + R[i]).logpdf(z[i]) for i in range(6)]
    assert np.allclose(seen.log_likelihood - np.log(2 * np.pi), exact)
