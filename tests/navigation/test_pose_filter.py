"""Against filterpy's unscented filter, whose hooks are written out in plain NumPy here."""

import numpy as np
import pytest
from filterpy.kalman import JulierSigmaPoints, UnscentedKalmanFilter

from navigation.angles import wrap, wrap_array
from navigation.landmark import sighting
from navigation.pose_filter import PoseFilter

LANDMARKS = np.array([[2.0, 1.0], [-1.5, 2.0], [0.5, -2.5]])
MOTION = np.diag([4e-4, 1e-4, 1e-3])
DRIFT = 1e-5


def _angle(values, weights):
    return np.arctan2(weights @ np.sin(values), weights @ np.cos(values))


def _less(period):
    def residual(a, b):
        rest = a - b
        rest[period - 1 :: period] = wrap_array(rest[period - 1 :: period])
        return rest

    return residual


def _mean(period):
    def mean(points, weights):
        total = weights @ points
        for k in range(period - 1, points.shape[1], period):
            total[k] = _angle(points[:, k], weights)
        return total

    return mean


def _moved(pose, dt, increment):
    middle = pose[2] + 0.5 * increment[2]
    c, s = np.cos(middle), np.sin(middle)
    dx, dy, turn = increment
    return pose + np.array([c * dx - s * dy, s * dx + c * dy, turn])


def _seen(pose, landmarks):
    return np.array([v for p in landmarks.tolist() for v in sighting(pose.tolist(), tuple(p))])


@pytest.fixture
def filterpys():
    points = JulierSigmaPoints(3, kappa=0.0, sqrt_method=lambda P: np.linalg.cholesky(P).T)
    return UnscentedKalmanFilter(
        dim_x=3,
        dim_z=2,
        dt=1.0,
        hx=_seen,
        fx=_moved,
        points=points,
        x_mean_fn=_mean(3),
        z_mean_fn=_mean(2),
        residual_x=_less(3),
        residual_z=_less(2),
    )


def _started(f, pose, covariance):
    f.x, f.P = np.array(pose), covariance.copy()
    return f


def test_it_is_filterpys(filterpys):
    rng = np.random.default_rng(0)
    P = np.diag([0.01, 0.02, 0.03])
    ours, theirs = (
        _started(PoseFilter(), (0.3, -0.2, 3.1), P),
        _started(filterpys, (0.3, -0.2, 3.1), P),
    )
    truth = np.array([0.35, -0.22, 3.12])
    for k in range(30):
        increment = rng.normal((0.02, 0.0, 0.02), 0.03)
        truth = _moved(truth, 1.0, increment)
        c, s = np.cos(theirs.x[2]), np.sin(theirs.x[2])
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        theirs.Q = turn @ MOTION @ turn.T + DRIFT * np.eye(3)
        theirs.predict(increment=increment)
        theirs.x[2] = wrap(theirs.x[2])
        ours.move(increment, MOTION, DRIFT)
        assert np.allclose(ours.x, theirs.x, rtol=0, atol=1e-12)
        assert np.allclose(ours.P, theirs.P, rtol=0, atol=1e-12)

        seen = LANDMARKS[: 1 + k % 3]
        noise = np.kron(np.eye(len(seen)), np.diag([0.02**2, 0.01**2]))
        noise[1::2, 1::2] += 1e-5
        z = _seen(truth, seen) + rng.normal(0.0, 0.01, 2 * len(seen))
        theirs.sigmas_f = theirs.points_fn.sigma_points(theirs.x, theirs.P)
        theirs.update(z, R=noise, landmarks=seen)
        theirs.x[2] = wrap(theirs.x[2])
        ours.spread()
        ours.correct(z.reshape(-1, 2), noise, seen)
        assert np.allclose(ours.x, theirs.x, rtol=0, atol=1e-12)
        assert np.allclose(ours.P, theirs.P, rtol=0, atol=1e-12)
    assert np.linalg.norm(ours.x[:2] - truth[:2]) < 0.05


def test_the_heading_stays_wrapped_and_the_covariance_symmetric():
    f = _started(PoseFilter(), (0.0, 0.0, 3.14), np.diag([0.01, 0.01, 0.1]))
    f.move(np.array([0.1, 0.05, 0.2]), MOTION, DRIFT)
    assert f.x[2] == pytest.approx(wrap(3.34), abs=0.01)
    f.spread()
    f.correct(np.array([[2.0, -2.9]]), np.diag([0.01, 0.01]), np.array([[-2.0, 0.5]]))
    assert -np.pi < f.x[2] <= np.pi
    assert np.array_equal(f.P, f.P.T)


@pytest.mark.parametrize("broken", [np.diag([1.0, -1.0, 1.0]), np.full((3, 3), np.nan)])
def test_a_covariance_that_is_none_is_told(broken):
    f = _started(PoseFilter(), (0.0, 0.0, 0.0), broken)
    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        f.move(np.zeros(3), MOTION, DRIFT)
    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        f.spread()
