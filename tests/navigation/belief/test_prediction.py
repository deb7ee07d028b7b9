from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navigation.belief.estimator import predict

angles = st.floats(-pi, pi)
poses = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), angles).map(np.array)


def matrix(pose):
    x, y, a = pose
    return np.array([[cos(a), -sin(a), x], [sin(a), cos(a), y], [0.0, 0.0, 1.0]])


@settings(max_examples=25)
@given(pose=poses, then=poses, now=poses)
def test_the_pose_moves_as_the_odometry_did(belief, view, pose, then, now):
    later = predict(belief(pose=pose), then, now, 1.06, view())
    expected = matrix(pose) @ np.linalg.inv(matrix(then)) @ matrix(now)
    assert matrix(later.pose) == pytest.approx(expected, abs=1e-9)
    assert abs(later.pose[2]) <= pi
    assert later.time == 1.06


def test_movers_move_on(belief, track, view):
    before = belief([track((1.0, 2.0), (0.1, -0.2))], time=1.0)
    (moved,) = predict(before, np.zeros(3), np.zeros(3), 1.5, view()).tracks
    assert moved.position == pytest.approx([1.05, 1.9])
