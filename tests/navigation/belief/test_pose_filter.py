"""Properties of the pose filter: limit of small noise, symmetries, order of the landmarks."""

from contextlib import suppress
from math import pi

import numpy as np
import pytest

from navigation.angles import wrap, wrap_array
from navigation.belief.pose_filter import PoseFilter
from navigation.transform import propagate, rotate
from tests.navigation.sightings import range_bearing

LANDMARKS = np.array([(1.5, -2.0), (-2.5, -1.0), (-1.0, 0.5)])
P = np.array([[4e-3, 1e-3, 0.0], [1e-3, 3e-3, 1e-3], [0.0, 1e-3, 2e-3]])
R = np.diag([1e-3, 1e-4] * 3) + 5e-5 * np.outer([0, 1] * 3, [0, 1] * 3)
Q = np.diag([1e-4, 2e-4, 3e-4])
INCREMENT = np.array([0.1, -0.02, 0.2])
HEADINGS = [0.3, pi - 0.01, -pi + 0.01, 1.57]


def observe(pose, landmarks=LANDMARKS):
    return np.array([v for p in landmarks.tolist() for v in range_bearing(pose, tuple(p))])


def jacobian(pose, landmarks=LANDMARKS):
    """Partial derivatives of distances and bearings with respect to the pose (2 k, 3)."""
    rows = []
    for x, y in landmarks.tolist():
        dx, dy = x - pose[0], y - pose[1]
        d = np.hypot(dx, dy)
        rows += [(-dx / d, -dy / d, 0.0), (dy / d**2, -dx / d**2, -1.0)]
    return np.array(rows)


@pytest.mark.parametrize("heading", HEADINGS)
def test_with_little_noise_it_is_the_extended_kalman_filter(heading):
    small, pose = 1e-6, np.array([0.4, -1.0, heading])
    f = PoseFilter(pose, small * P)
    f.predict(INCREMENT, small * Q)
    end = np.array([*rotate(0.5 * INCREMENT[2], tuple(INCREMENT[:2])), INCREMENT[2]])
    mean, F = propagate(pose, np.zeros(3), end)
    mean[2] = wrap(mean[2])
    predicted = small * (F @ P @ F.T + Q)
    assert f.pose == pytest.approx(mean, abs=1e-8)
    assert f.covariance == pytest.approx(predicted, rel=1e-4, abs=1e-12)

    z = observe(mean + np.array([1e-3, -1e-3, 1e-3]))
    y, H = z - observe(mean), jacobian(mean)
    y[1::2] = wrap_array(y[1::2])
    S = H @ predicted @ H.T + small * R
    K = predicted @ H.T @ np.linalg.inv(S)
    for k, distance in enumerate(f.nis(z, small * R, LANDMARKS)):
        rows = slice(2 * k, 2 * k + 2)
        expected = y[rows] @ np.linalg.solve(S[rows, rows], y[rows])
        assert distance == pytest.approx(expected, rel=0.02)
    f.update(z, small * R, LANDMARKS)
    corrected = mean + K @ y
    corrected[2] = wrap(corrected[2])
    assert f.pose == pytest.approx(corrected, abs=1e-5)
    assert f.covariance == pytest.approx((np.eye(3) - K @ H) @ predicted, rel=1e-3, abs=1e-11)


def test_the_sigma_points_have_the_fourth_moment_of_a_normal_distribution():
    """After a metre with an uncertain heading the mean is exp(-variance / 2) m ahead."""
    sigma = 0.5
    f = PoseFilter(np.zeros(3), np.diag([1e-6, 1e-6, sigma**2]))
    f.predict(np.array([1.0, 0.0, 0.0]), 1e-6 * np.eye(3))
    assert f.pose == pytest.approx([np.exp(-0.5 * sigma**2), 0.0, 0.0], abs=3e-4)


@pytest.mark.parametrize("heading", HEADINGS)
def test_turning_the_world_turns_the_estimate(heading):
    """Heading 0 is far from the wrap, and its estimate is the reference.

    The directions of the sigma points depend on the axes, and a second-order error with them.
    """
    estimates = []
    for turn in (0.0, heading):
        T = np.eye(3)
        T[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
        landmarks = LANDMARKS @ T[:2, :2].T
        f = PoseFilter(np.array([0.0, 0.0, turn]), T @ P @ T.T)
        f.predict(INCREMENT, T @ Q @ T.T)
        z = observe((0.13, 0.05, 0.15))
        f.update(z, R, landmarks)
        assert -pi < f.pose[2] <= pi
        position = T[:2, :2].T @ f.pose[:2]
        estimates.append(([*position, wrap(f.pose[2] - turn)], T.T @ f.covariance @ T))
    (pose, covariance), (turned, turned_covariance) = estimates
    assert turned == pytest.approx(pose, abs=1e-3)
    assert turned_covariance == pytest.approx(covariance, abs=2e-5)


@pytest.mark.parametrize("broken", [-np.eye(3), np.diag([1.0, -1.0, 1.0]), np.zeros((3, 3))])
def test_a_covariance_that_is_not_positive_definite_is_an_error(broken):
    pose, z = np.array([0.4, -1.0, 0.2]), observe((0.4, -1.0, 0.2))
    assert PoseFilter(pose, P).is_valid()
    assert not PoseFilter(pose, broken).is_valid()
    for use in (
        lambda f: f.predict(np.zeros(3), np.zeros((3, 3))),
        lambda f: f.nis(z, R, LANDMARKS),
        lambda f: f.update(z, R, LANDMARKS),
    ):
        with pytest.raises(np.linalg.LinAlgError):
            use(PoseFilter(pose, broken))


@pytest.mark.parametrize(
    ("pose", "covariance"), [((np.nan, 0.0, 0.0), P), ((0.0, 0.0, 0.0), np.full((3, 3), np.nan))]
)
def test_a_number_that_is_not_finite_stays_invalid(pose, covariance):
    f = PoseFilter(np.array(pose), covariance)
    assert not f.is_valid()
    with suppress(np.linalg.LinAlgError):
        f.predict(INCREMENT, Q)
        f.update(observe((0.4, -1.0, 0.2)), R, LANDMARKS)
    assert not f.is_valid()
