from copy import deepcopy
from math import pi

import numpy as np
import pytest

from navigation.angles import wrap
from navigation.belief.pose_filter import nis, pose_filter
from navigation.transform import propagate, range_bearing

LANDMARKS = np.array([(1.5, -2.0), (-2.5, -1.0), (-1.0, 0.5)])
P = np.array([[4e-3, 1e-3, 0.0], [1e-3, 3e-3, 1e-3], [0.0, 1e-3, 2e-3]])
R = np.diag([1e-3, 1e-4] * 3)


def made(pose):
    f = pose_filter()
    f.x, f.P = np.array(pose, float), P.copy()
    f.sigmas_f = f.points_fn.sigma_points(f.x, f.P)
    return f


def measured(pose):
    return np.array([v for p in LANDMARKS.tolist() for v in range_bearing(pose, tuple(p))])


@pytest.mark.parametrize("heading", [0.3, pi - 0.01, -pi + 0.01, 1.57])
def test_the_nis_of_a_landmark_is_that_of_its_own_update(heading):
    f = made((0.4, -1.0, heading))
    z = measured((0.42, -0.95, heading + 0.03))
    for k, distance in enumerate(nis(f, z, R, LANDMARKS)):
        alone, rows = deepcopy(f), slice(2 * k, 2 * k + 2)
        alone.update(z[rows], R=R[rows, rows], landmarks=LANDMARKS[k : k + 1])
        assert distance == pytest.approx(alone.mahalanobis**2)


@pytest.mark.parametrize("heading", [0.3, pi - 0.01, -pi + 0.01])
def test_an_update_does_not_depend_on_the_direction_of_the_axes(heading):
    """At the seam of the angles as elsewhere: landmarks and pose rotated about the origin."""
    f = made((0.0, 0.0, 0.0))
    f.update(measured((0.05, 0.02, 0.04)), R=R, landmarks=LANDMARKS)
    c, s = np.cos(heading), np.sin(heading)
    T = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    turned = made((0.0, 0.0, heading))
    turned.P = T @ P @ T.T
    turned.sigmas_f = f.points_fn.sigma_points(turned.x, turned.P)
    turned.update(measured((0.05, 0.02, 0.04)), R=R, landmarks=LANDMARKS @ T[:2, :2].T)
    offset = turned.x - T @ f.x
    assert np.allclose([*offset[:2], wrap(offset[2] - heading)], 0.0, atol=1e-3)
    assert np.allclose(turned.P, T @ f.P @ T.T, atol=1e-5)


@pytest.mark.parametrize("heading", [0.3, pi - 0.01])
def test_a_prediction_moves_a_certain_pose_by_the_midpoint_rule(heading):
    f = made((0.4, -1.0, heading))
    f.P, f.Q = 1e-14 * np.eye(3), np.zeros((3, 3))
    f.predict(increment=np.array([0.1, -0.02, 0.2]))
    c, s = np.cos(0.1), np.sin(0.1)
    step = np.array([c * 0.1 + s * 0.02, s * 0.1 - c * 0.02, 0.2])
    wanted, _ = propagate(np.array([0.4, -1.0, heading]), np.zeros(3), step)
    assert np.allclose(f.x[:2], wanted[:2], atol=1e-9)
    assert wrap(f.x[2] - wanted[2]) == pytest.approx(0.0, abs=1e-9)
