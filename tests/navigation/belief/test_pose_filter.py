from copy import deepcopy
from math import pi

import numpy as np
import pytest

from navigation.belief.pose_filter import nis, pose_filter
from navigation.transform import range_bearing

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
