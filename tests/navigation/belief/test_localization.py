from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from navigation.angles import wrap
from navigation.belief.localization import Localizer
from navigation.observation import CameraModel, CameraView, Frame
from navigation.parameters.belief import LocalizationParameters
from tests.navigation.sightings import range_bearing
from vision.detection import Detection

BEACONS = {f"b{i}": (3.0 * cos(i * pi / 4), 3.0 * sin(i * pi / 4)) for i in range(8)}
P0 = np.eye(3) * 4e-4
DT = 0.1


VIEW = CameraView(np.eye(3), np.zeros(3), 0.0, 0.0, CameraModel(1.5, 1.2))


SLIP, DRIFT, TURN_DRIFT, FOOTSTEP = 0.03, 0.003, 0.006, 0.34


def frame(time, odometry, observations, motion=(4e-6, 4e-6, 1e-6), yaw_sigma=0.0):
    view = replace(VIEW, model=replace(VIEW.model, yaw_sigma=yaw_sigma))
    return Frame(time, np.array(odometry, float), np.diag(motion), view, tuple(observations))


def beacon(pose, name, noise=(0.0, 0.0), position=None):
    distance, bearing = range_bearing(pose, position or BEACONS[name])
    return Detection(
        kind="beacon",
        label=name,
        distance=distance + noise[0],
        bearing=bearing + noise[1],
        covariance=np.diag([0.05**2, 0.02**2]),
        radius=0.05,
        radius_sigma=0.01,
        by_radius=np.zeros(2),
        cut=False,
        occluded=False,
        box=(0, 0, 0, 0),
    )


def walk(rng, start, seconds, names_at, parameters=None, speed=0.15, turn=0.4):
    """Walk in circles with slipping odometry; yield the localizer and the true pose."""
    pose, odometry = np.array(start, float), np.zeros(3)
    localizer = Localizer(parameters or LocalizationParameters(), BEACONS, pose, P0)
    frames = FOOTSTEP / DT
    for k in range(1, int(seconds / DT)):
        slip = rng.normal(0, SLIP * np.sqrt(frames), 3)
        drift = rng.normal(0, [DRIFT, DRIFT, TURN_DRIFT]) * np.sqrt(frames)
        body = np.array([speed, 0.0, turn])
        motion = frames * DT**2 * ((SLIP * body) ** 2 + np.square([DRIFT, DRIFT, TURN_DRIFT]))
        for u, q in ((body * (1 + slip) + drift, pose), (body, odometry)):
            middle = q[2] + 0.5 * u[2] * DT
            q[0] += DT * (cos(middle) * u[0] - sin(middle) * u[1])
            q[1] += DT * (sin(middle) * u[0] + cos(middle) * u[1])
            q[2] += DT * u[2]
        observed = [
            beacon(pose, n, (rng.normal(0, 0.05), rng.normal(0, 0.02))) for n in names_at(k)
        ]
        localizer.update(frame(k * DT, odometry, observed, motion))
        yield localizer, pose


def test_is_consistent_for_every_heading():
    nees = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        start = (0.0, 0.0, pi - 0.01 + 0.02 * (seed % 2))
        turn = 0.0 if seed < 3 else 0.4
        names = list(BEACONS)
        for k, (localizer, pose) in enumerate(
            walk(rng, start, 20.0, lambda k, n=names: [n[k % 8]], turn=turn, speed=0.05)
        ):
            error = localizer.pose - pose
            error[2] = wrap(error[2])
            assert -pi < localizer.pose[2] <= pi
            assert abs(error[2]) < 0.3
            if k > 20:
                nees.append(error @ np.linalg.solve(localizer.covariance, error) / 3)
    assert 0.6 < np.mean(nees) < 1.6


def updates(count, seed):
    """Random odometry, gaps, noise and beacons, outliers among them, for so many frames."""
    rng = np.random.default_rng(seed)
    localizer = Localizer(LocalizationParameters(), BEACONS, np.zeros(3), P0)
    pose, time = np.zeros(3), 0.0
    for _ in range(count):
        time += float(rng.choice([0.06, 0.06, 0.5, 5.0]))
        motion = 10.0 ** rng.uniform(-9, -3, 3)
        step = rng.normal((0.01, 0.0, 0.02), np.sqrt(motion))
        c, s = cos(pose[2]), sin(pose[2])
        pose += [c * step[0] - s * step[1], s * step[0] + c * step[1], step[2]]
        observed = []
        for name in rng.choice(list(BEACONS), rng.integers(0, 4), replace=False).tolist():
            sigma = 10.0 ** rng.uniform(-4, -0.5, 2)
            scale = 1.0 if rng.random() > 0.02 else 100.0
            observation = beacon(pose, name, noise=scale * rng.normal(0, sigma))
            observed.append(replace(observation, covariance=np.diag(sigma**2)))
        localizer.update(frame(time, pose, observed, motion))
        covariance = localizer.covariance
        assert np.array_equal(covariance, covariance.T)
        assert np.linalg.eigvalsh(covariance)[0] > 0.0
    assert localizer.faults == 0


def test_covariance_stays_positive_definite_over_300_random_updates():
    updates(300, seed=7)


def test_a_beacon_reported_twice_counts_once():
    results = []
    for names in (["b0"], ["b0", "b0"]):
        localizer = Localizer(LocalizationParameters(), BEACONS, np.zeros(3), P0)
        localizer.update(frame(0.1, (0, 0, 0), [beacon((0, 0, 0), n) for n in names]))
        results.append(localizer.covariance)
    assert np.array_equal(*results)


def test_odometry_alone_moves_the_pose_and_adds_noise_along_the_body():
    """By the chord at the middle heading; the noise of the way ahead is that of y in W."""
    localizer = Localizer(LocalizationParameters(), {}, np.array([1.0, 2.0, pi / 2]), P0 * 1e-4)
    localizer.update(frame(0.0, (5, 5, 1.0), []))
    motion = (4e-4, 1e-4, 1e-8)
    localizer.update(frame(1e-6, (5 + cos(1.1), 5 + sin(1.1), 1.2), [], motion))
    expected = [1.0 + cos(pi / 2 + 0.1), 2.0 + sin(pi / 2 + 0.1), pi / 2 + 0.2]
    assert localizer.pose == pytest.approx(expected, abs=1e-6)
    assert np.diag(localizer.covariance)[:2] == pytest.approx((1e-4, 4e-4), rel=2e-3)


def test_a_displaced_beacon_is_detected_and_ignored():
    localizer = Localizer(LocalizationParameters(), BEACONS, np.zeros(3), P0)
    moved = beacon((0, 0, 0), "b0", position=(3.0, 0.5))
    for k in range(1, 40):
        localizer.update(frame(k * DT, (0, 0, 0), [moved, beacon((0, 0, 0), "b1")]))
    for k in range(40, 100):
        localizer.update(frame(k * DT, (0, 0, 0), [moved]))
    assert not localizer.lost
    assert np.hypot(*localizer.pose[:2]) < 0.05


def test_a_broken_filter_is_counted_and_started_again():
    localizer = Localizer(LocalizationParameters(), BEACONS, np.zeros(3), -np.eye(3))
    localizer.update(frame(0.0, (0, 0, 0), [beacon((0, 0, 0), "b0")]))
    assert localizer.faults == 1
    assert localizer.lost
    for k in range(1, 4):
        observed = [beacon((0, 0, 0), "b0"), beacon((0, 0, 0), "b2")]
        localizer.update(frame(k * DT, (0, 0, 0), observed))
    assert not localizer.lost
    assert localizer.faults == 1


def test_an_old_frame_is_refused():
    localizer = Localizer(LocalizationParameters(), BEACONS, np.zeros(3), P0)
    localizer.update(frame(1.0, (0, 0, 0), []))
    with pytest.raises(ValueError, match="order of capture"):
        localizer.update(frame(1.0, (0, 0, 0), []))


def test_the_information_of_a_frame_is_added_with_all_correlations():
    """Against the linear filter in its information form, the shared error between all bearings."""
    names, shared = ("b0", "b3", "b5"), 0.015
    H, R = [], np.zeros((6, 6))
    R[1::2, 1::2] = shared**2
    for k, name in enumerate(names):
        x, y = BEACONS[name]
        H += [[-x / 3.0, -y / 3.0, 0.0], [y / 9.0, -x / 9.0, -1.0]]
        R[2 * k, 2 * k], R[2 * k + 1, 2 * k + 1] = 0.05**2, 0.02**2
    H = np.array(H)
    expected = np.linalg.inv(np.linalg.inv(P0) + H.T @ np.linalg.solve(R, H))
    localizer = Localizer(LocalizationParameters(), BEACONS, np.zeros(3), P0)
    observed = [beacon((0, 0, 0), name) for name in names]
    localizer.update(frame(0.1, (0, 0, 0), observed, yaw_sigma=shared))
    np.testing.assert_allclose(localizer.covariance, expected, atol=0.01 * expected.max())


def test_a_shared_yaw_error_beyond_the_bearings_leaves_the_noise_a_covariance():
    """Bearings that depend on the distance have less noise of their own."""
    correlated = np.array([[0.05**2, 0.8 * 0.05 * 0.02], [0.8 * 0.05 * 0.02, 0.02**2]])
    localizer = Localizer(LocalizationParameters(), BEACONS, np.zeros(3), P0)
    for k in range(1, 20):
        observed = [
            replace(beacon((0, 0, 0), name), covariance=correlated) for name in ("b0", "b1", "b2")
        ]
        localizer.update(frame(k * DT, (0, 0, 0), observed, yaw_sigma=0.05))
        assert np.linalg.eigvalsh(localizer.covariance).min() > 0.0
    assert localizer.faults == 0
