from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from navigation.angles import wrap
from navigation.belief.belief import Motion
from navigation.belief.ekf_slam import EkfSlam
from navigation.parameters.belief import BeliefParameters
from tests.navigation.sightings import range_bearing

DT = 0.1
MOTION = (4e-6, 4e-6, 4e-7)  # variances per frame, forward, left and turn
SIGMA = (0.01, 0.004)
COLORS = ("red", "green", "blue", "violet")
POSTS = [(1.6 * cos(a), 1.6 * sin(a), COLORS[i % 4]) for i, a in enumerate(np.arange(8) * pi / 4)]


def tracks(track, numbers, motion=Motion.STATIC, visible=True):
    """Tracks of posts by their numbers, as the tracker would publish them."""
    age = 0.0 if visible else 1.0
    return tuple(
        replace(
            track(POSTS[k][:2], id=k, motion=motion, age=age), label=POSTS[k][2], visible=visible
        )
        for k in numbers
    )


def tour(observe, frame, track, rng, seconds, fov=1.5):
    """Walk in a circle among the posts; yield localizer and true pose."""
    pose = np.array([0.5, -0.4, 0.3])
    slam = EkfSlam(BeliefParameters(), pose)
    odometry = np.zeros(3)
    slam.update(frame(0.0, odometry, []))
    for k in range(1, round(seconds / DT)):
        step = np.array([0.015, 0.0, 0.03])
        for q, u in ((odometry, step), (pose, step + rng.normal(0, np.sqrt(MOTION)))):
            c, s = cos(q[2]), sin(q[2])
            q += [c * u[0] - s * u[1], s * u[0] + c * u[1], u[2]]
        observed, numbers = [], []
        for i, (x, y, label) in enumerate(POSTS):
            _, bearing = range_bearing(pose.tolist(), (x, y))
            if abs(bearing) < fov / 2:
                observed.append(
                    observe(
                        pose.tolist(), (x, y), label=label, noise=rng.normal(0, SIGMA), sigma=SIGMA
                    )
                )
                numbers.append(i)
        f = replace(frame(k * DT, odometry, observed), motion_covariance=np.diag(MOTION))
        slam.update(f)
        slam.map_landmarks(
            f,
            tracks(track, range(8), visible=False)
            if k < 3
            else tracks(track, numbers)
            + tracks(track, set(range(8)) - set(numbers), visible=False),
        )
        yield slam, pose


def nees(slam, pose):
    e = slam.pose - pose
    e[2] = wrap(float(e[2]))
    return float(e @ np.linalg.solve(slam.covariance, e)) / 3


def last(steps):
    """The localizer and the true pose in the end."""
    return list(steps)[-1]


def test_is_consistent_and_better_than_odometry(observe, frame, track):
    values, errors, blind = [], [], []
    for seed in range(4):
        for fov, away in ((1.5, errors), (0.0, blind)):
            slam, pose = last(tour(observe, frame, track, np.random.default_rng(seed), 30.0, fov))
            assert len(slam._ids) == (8 if fov else 0)
            away.append(np.hypot(*(slam.pose - pose)[:2]))
            if fov:
                values.append(nees(slam, pose))
    assert 0.3 < np.mean(values) < 2.0
    assert np.sqrt(np.mean(np.square(errors))) < 0.5 * np.sqrt(np.mean(np.square(blind)))


def test_a_landmark_is_correlated_with_the_pose_that_mapped_it(observe, frame, track):
    """Detected from the pose at which it was mapped, it adds no information."""
    slam = EkfSlam(BeliefParameters(), np.zeros(3))
    wander = replace(frame(0.1, (0, 0, 0), []), motion_covariance=np.diag([1e-2, 1e-2, 1e-3]))
    slam.update(frame(0.0, (0, 0, 0), []))
    slam.update(wander)
    first = frame(0.2, (0, 0, 0), [observe((0, 0, 0), POSTS[0][:2], sigma=SIGMA)])
    slam.update(first)
    slam.map_landmarks(first, tracks(track, [0]))
    before = np.linalg.det(slam.covariance)
    for k in range(3, 40):
        still = replace(
            frame(0.1 * k, (0, 0, 0), [observe((0, 0, 0), POSTS[0][:2], sigma=SIGMA)]),
            motion_covariance=np.zeros((3, 3)),
        )
        slam.update(still)
    assert np.linalg.det(slam.covariance) == pytest.approx(before, rel=0.05)


def test_an_error_that_all_bearings_share_leaves_the_heading_uncertain(observe, frame, track):
    """Eight landmarks seen again after an uncertain turn."""
    here, variances = (0.0, 0.0, 0.0), []
    posts = [observe(here, (x, y), label=label, sigma=SIGMA) for x, y, label in POSTS]
    for shared in (0.0, SIGMA[1]):
        slam = EkfSlam(BeliefParameters(), np.zeros(3))
        first, again = frame(0.0, here, posts), frame(9.0, here, posts)
        slam.update(first)
        slam.map_landmarks(first, tracks(track, range(8)))
        view = replace(again.view, model=replace(again.view.model, yaw_sigma=shared))
        turned = np.diag([1e-6, 1e-6, 1e-2])
        slam.update(replace(again, motion_covariance=turned, view=view))
        variances.append(slam.covariance[2, 2])
    assert variances[1] - variances[0] > 0.5 * SIGMA[1] ** 2


def test_landmarks_that_move_are_deleted(observe, frame, track):
    slam, _ = last(tour(observe, frame, track, np.random.default_rng(2), 20.0))
    pose, covariance = slam.pose, slam.covariance
    slam.map_landmarks(
        frame(99.0, (0, 0, 0), []),
        tracks(track, [1, 2], visible=False) + tracks(track, [3], Motion.MOVING),
    )
    assert set(slam._ids) == {1, 2}
    assert np.array_equal(slam.pose, pose)
    assert np.array_equal(slam.covariance, covariance)


def test_the_landmarks_that_remain_keep_their_positions(observe, frame, track):
    here, slam = (0.0, 0.0, 0.0), EkfSlam(BeliefParameters(), np.zeros(3))
    posts = [observe(here, (x, y), label=label, sigma=SIGMA) for x, y, label in POSTS]
    first = frame(0.0, here, posts)
    slam.update(first)
    slam.map_landmarks(first, tracks(track, range(8)))
    slam.map_landmarks(frame(0.1, here, []), tracks(track, [4, 6], visible=False))
    again = frame(9.0, here, [posts[4], posts[6]])
    slam.update(replace(again, motion_covariance=1e-2 * np.eye(3)))
    assert slam.pose == pytest.approx(np.zeros(3), abs=1e-6)
    assert np.diag(slam.covariance).max() < 2e-3


PLACES = [  # no two arrangements of these are alike
    (1.2, 0.1, "red"),
    (1.5, 0.9, "green"),
    (0.3, 1.4, "blue"),
    (-0.9, 1.1, "red"),
    (-1.5, 0.1, "violet"),
    (-0.8, -0.9, "green"),
    (0.2, -1.3, "violet"),
    (1.3, -0.8, "blue"),
]


def look_around(
    slam, observe, frame, track, rng, times, *, where=(0.0, 0.0, 0.0), hidden=(), **flags
):
    """The robot turns about on the spot of its odometry, which stands at `where` in truth.

    `flags` are those of all detections.
    """
    for k in times:
        turn = 0.05 * k
        x, y, heading = where
        pose = (x, y, heading + turn)
        observed, numbers = [], []
        for i, (px, py, label) in enumerate(PLACES):
            distance, bearing = range_bearing(pose, (px, py))
            if abs(bearing) < 0.7 and distance < 2.5 and i not in hidden:
                seen = observe(pose, (px, py), label=label, noise=rng.normal(0, SIGMA), sigma=SIGMA)
                observed.append(replace(seen, **flags))
                numbers.append(i)
        f = frame(DT * k, (0.0, 0.0, turn), observed)
        slam.update(f)
        slam.map_landmarks(f, tuple(
            replace(track(PLACES[i][:2], id=i), label=PLACES[i][2]) for i in range(len(PLACES))
            if i in numbers or i in slam._ids
        ))  # fmt: skip
        yield slam, np.array(pose)


@pytest.fixture
def mapped(observe, frame, track):
    """A robot at the origin that has mapped all places, and what goes on with it."""
    slam, rng = EkfSlam(BeliefParameters(), np.zeros(3)), np.random.default_rng(6)

    def go_on(frames, **changes):
        start = go_on.next
        go_on.next += frames
        times = range(start, go_on.next)
        return list(look_around(slam, observe, frame, track, rng, times, **changes))

    go_on.next = 0
    go_on(130)
    assert len(slam._ids) == len(PLACES)
    assert not slam.lost
    return slam, go_on


def test_kidnapped_it_detects_the_failure_and_relocalizes(mapped):
    slam, go_on = mapped
    go_on(10, where=(0.4, -0.5, 1.9))
    assert slam.lost or slam.recoveries
    go_on(60, where=(0.4, -0.5, 1.9))
    _, pose = go_on(1, where=(0.4, -0.5, 1.9))[-1]
    assert slam.recoveries == 1
    assert not slam.lost
    assert np.hypot(*(slam.pose - pose)[:2]) < 0.05
    assert abs(wrap(float(slam.pose[2] - pose[2]))) < 0.03


def test_one_missing_landmark_is_not_a_failure(mapped):
    slam, go_on = mapped
    go_on(130, hidden=(3,))
    assert not slam.lost
    assert slam.recoveries == 0


@pytest.mark.parametrize("flag", ["cut", "occluded"])
def test_landmarks_that_are_partly_visible_are_not_missing(mapped, flag):
    slam, go_on = mapped
    go_on(30, **{flag: True})
    assert not slam.lost
    assert slam.recoveries == 0
