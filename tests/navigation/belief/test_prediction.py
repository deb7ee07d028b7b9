from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navigation.belief.belief import Belief, Motion, Track
from navigation.belief.estimator import predict
from navigation.belief.local_map import LocalMap
from navigation.observation import CameraView
from navigation.parameters.belief import LocalMapParameters

VIEW = CameraView(np.eye(3), np.zeros(3), 0.0, 0.0, 1.5, 1.2)
angles = st.floats(-pi, pi)
poses = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), angles).map(np.array)


def belief(pose) -> Belief:
    track = Track(
        id=1,
        label="red",
        position=np.array([1.0, 2.0]),
        velocity=np.array([0.1, -0.2]),
        covariance=np.eye(4) * 1e-3,
        radius=0.08,
        radius_sigma=0.01,
        motion=Motion.MOVING,
        hits=5,
        age=0.0,
        last_seen=np.array([1.0, 2.0]),
        visible=True,
    )
    return Belief(
        time=1.0,
        pose=np.array(pose, float),
        pose_covariance=np.diag([1e-4, 4e-4, 1e-4]),
        tracks=(track,),
        local_map=LocalMap(LocalMapParameters(), (0.0, 0.0), 1.0),
        view=VIEW,
        seen_beacons=(),
        lost=False,
        filter_faults=0,
    )


def matrix(pose):
    x, y, a = pose
    return np.array([[cos(a), -sin(a), x], [sin(a), cos(a), y], [0.0, 0.0, 1.0]])


@settings(max_examples=25)
@given(pose=poses, then=poses, now=poses)
def test_the_pose_moves_as_the_odometry_did(pose, then, now) -> None:
    later = predict(belief(pose), then, now, 1.06, VIEW)
    expected = matrix(pose) @ np.linalg.inv(matrix(then)) @ matrix(now)
    assert matrix(later.pose) == pytest.approx(expected, abs=1e-9)
    assert abs(later.pose[2]) <= pi
    assert later.time == 1.06


@settings(max_examples=25)
@given(pose=poses, then=poses, now=poses)
def test_the_covariance_follows_the_motion(pose, then, now) -> None:
    def moved(p):
        return predict(belief(p), then, now, 1.06, VIEW).pose

    J = np.zeros((3, 3))
    for k in range(3):
        step = np.zeros(3)
        step[k] = 1e-6
        difference = moved(pose + step) - moved(pose - step)
        difference[2] = (difference[2] + pi) % (2.0 * pi) - pi
        J[:, k] = difference / 2e-6
    before = belief(pose)
    after = predict(before, then, now, 1.06, VIEW).pose_covariance
    assert after == pytest.approx(J @ before.pose_covariance @ J.T, abs=1e-9)


def test_movers_move_on() -> None:
    (track,) = predict(belief((0, 0, 0)), np.zeros(3), np.zeros(3), 1.5, VIEW).tracks
    assert track.position == pytest.approx([1.05, 1.9])
