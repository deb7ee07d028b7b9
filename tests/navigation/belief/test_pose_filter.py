"""Against filterpy's unscented Kalman filter."""

from math import pi

import numpy as np
import pytest
from filterpy.kalman import JulierSigmaPoints, UnscentedKalmanFilter

from navigation.angles import wrap, wrap_array
from navigation.belief import pose_filter
from tests.navigation.sightings import range_bearing

LANDMARKS = np.array([(1.5, -2.0), (-2.5, -1.0), (-1.0, 0.5)])
P = np.array([[4e-3, 1e-3, 0.0], [1e-3, 3e-3, 1e-3], [0.0, 1e-3, 2e-3]])
R = np.diag([1e-3, 1e-4] * 3) + 5e-5 * np.outer([0, 1] * 3, [0, 1] * 3)
HEADINGS = [0.3, pi - 0.01, -pi + 0.01, 1.57]


def circular(angles, weights):
    return np.arctan2(weights @ np.sin(angles), weights @ np.cos(angles))


def mean_of(first):
    def mean(points, weights):
        result = weights @ points
        result[first :: first + 1] = circular(points[:, first :: first + 1], weights)
        return result

    return mean


def difference_of(first):
    def difference(a, b):
        result = a - b
        result[first :: first + 1] = wrap_array(result[first :: first + 1])
        return result

    return difference


def observe(pose, landmarks):
    return np.array([v for p in landmarks.tolist() for v in range_bearing(pose, tuple(p))])


def move(pose, dt, increment):
    dx, dy, turn = increment
    middle = pose[2] + 0.5 * turn
    c, s = np.cos(middle), np.sin(middle)
    return pose + np.array([c * dx - s * dy, s * dx + c * dy, turn])


def reference(pose):
    f = UnscentedKalmanFilter(
        dim_x=3,
        dim_z=2,
        dt=1.0,
        fx=move,
        hx=observe,
        points=JulierSigmaPoints(3, kappa=0.0),
        x_mean_fn=mean_of(2),
        z_mean_fn=mean_of(1),
        residual_x=difference_of(2),
        residual_z=difference_of(1),
        state_add=lambda x, step: np.array([*(x + step)[:2], wrap((x + step)[2])]),
    )
    f.x, f.P = np.array(pose, float), P.copy()
    return f


@pytest.mark.parametrize("heading", HEADINGS)
def test_predictions_and_corrections_are_those_of_filterpy(heading):
    f, pose, covariance = reference((0.4, -1.0, heading)), np.array([0.4, -1.0, heading]), P.copy()
    increment, Q = np.array([0.1, -0.02, 0.2]), np.diag([1e-4, 2e-4, 3e-4])
    f.Q = Q
    f.predict(increment=increment)
    assert pose_filter.predict(pose, covariance, increment, Q)
    assert pose == pytest.approx(f.x)
    assert covariance == pytest.approx(f.P)
    z = observe((0.5, -0.95, heading + 0.23), LANDMARKS)
    f.sigmas_f = f.points_fn.sigma_points(f.x, f.P)
    f.update(z, R=R, landmarks=LANDMARKS)
    assert pose_filter.correct(pose, covariance, z, R, LANDMARKS)
    assert pose == pytest.approx(f.x)
    assert covariance == pytest.approx(f.P)
    assert pose_filter.is_valid(pose, covariance)


@pytest.mark.parametrize("heading", HEADINGS)
def test_the_nis_of_a_landmark_is_that_of_its_own_update(heading):
    pose = np.array([0.4, -1.0, heading])
    z = observe((0.42, -0.95, heading + 0.03), LANDMARKS)
    for k, distance in enumerate(pose_filter.nis(pose, P, z, R, LANDMARKS)):
        f, rows = reference(pose), slice(2 * k, 2 * k + 2)
        f.sigmas_f = f.points_fn.sigma_points(f.x, f.P)
        f.update(z[rows], R=R[rows, rows], landmarks=LANDMARKS[k : k + 1])
        assert distance == pytest.approx(f.mahalanobis**2)


@pytest.mark.parametrize("broken", [-np.eye(3), np.full((3, 3), np.nan), np.zeros((3, 3))])
def test_a_covariance_that_is_not_positive_definite_is_reported(broken):
    pose, z = np.array([0.4, -1.0, 0.2]), observe((0.4, -1.0, 0.2), LANDMARKS)
    assert not pose_filter.is_valid(pose, broken)
    assert not pose_filter.predict(pose.copy(), broken.copy(), np.zeros(3), np.zeros((3, 3)))
    assert not pose_filter.correct(pose.copy(), broken.copy(), z, R, LANDMARKS)
    assert np.isinf(pose_filter.nis(pose, broken, z, R, LANDMARKS)).all()
