"""Pan and tilt of the camera, on head joints in either order."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.body.posture import head_joints
from walking.body.robot_model import Neck
from walking.body.tree import turn
from walking.model import Joint, Model, NeckRecord

ANGLES = st.floats(-0.6, 0.6)


def with_tilt_first(tree):
    """The same head with its tilt joint below the pan joint, at the place of the pan joint."""
    pan, tilt = tree.head
    parents, positions, axes = tree.parents.copy(), tree.positions.copy(), tree.axes.copy()
    axes[[pan, tilt]] = axes[[tilt, pan]]
    return replace(tree, parents=parents, positions=positions, axes=axes, head=(tilt, pan))


def with_camera_turned(tree, axis, angle):
    camera = tree.camera
    return replace(tree, camera=replace(camera, rotation=turn(axis, angle) @ camera.rotation))


def camera_pose(robot, angles):
    """Rotation (3, 3) and position (3,) of the camera in the base frame."""
    return robot.frame_pose(robot.tree.camera, angles)


def joints_of(neck, tree, pan, tilt):
    """Head joints that a neck turns to pan and tilt."""
    record, joints = np.zeros(1, Model)[0], np.zeros(tree.lower.size, Joint)
    neck.describe(record.neck)
    joints["lower"], joints["upper"] = tree.lower, tree.upper
    return head_joints(pan, tilt, joints, record)


def test_the_camera_looks_where_the_head_points(robot):
    q = robot.ready.copy()
    q[list(robot.tree.head)] = 0.5 * pi, 0.0
    R, _ = camera_pose(robot, q)
    np.testing.assert_allclose(R[:, 2], [0.0, 1.0, 0.0], atol=1e-9)
    q[list(robot.tree.head)] = 0.0, 0.3
    R, _ = camera_pose(robot, q)
    np.testing.assert_allclose(R[:, 2], [cos(0.3), 0.0, sin(0.3)], atol=1e-9)
    assert R[2, 1] < 0.0
    assert np.linalg.det(R) == pytest.approx(1.0)


@given(pan=ANGLES, tilt=st.floats(-0.6, 0.3), turned=st.booleans(), first=st.booleans())
def test_joints_are_the_inverse_of_angles(robot, pan, tilt, turned, first):
    tree = with_tilt_first(robot.tree) if first else robot.tree
    tree = replace(tree, lower=tree.lower - 2.0, upper=tree.upper + 2.0)
    if turned:
        tree = with_camera_turned(tree, np.array([0.0, 1.0, 0.0]), 0.2)
    neck, q = Neck(tree), tree.posture.copy()
    q[list(tree.head)] = joints_of(neck, tree, pan, tilt)
    assert neck.angles(q) == pytest.approx((pan, tilt), abs=1e-9)


def test_targets_out_of_range_stop_at_the_range(robot):
    neck, q = robot.neck, robot.ready.copy()
    (low_pan, high_pan), (low_tilt, high_tilt) = neck.range().tolist()
    q[list(robot.tree.head)] = joints_of(neck, robot.tree, 3.0, -3.0)
    assert neck.angles(q) == pytest.approx((high_pan, low_tilt))
    q[list(robot.tree.head)] = joints_of(neck, robot.tree, -3.0, 3.0)
    assert neck.angles(q) == pytest.approx((low_pan, high_tilt))


@given(pan=ANGLES, tilt=ANGLES)
def test_rates_are_the_derivative_of_the_angles(robot, pan, tilt):
    neck, q, step = robot.neck, robot.ready.copy(), 1e-6
    rates, record = np.zeros_like(q), np.zeros(1, NeckRecord)[0]
    neck.describe(record)
    q[list(robot.tree.head)], rates[list(robot.tree.head)] = (pan, 0.5 * tilt), (0.7, -0.4)
    ahead, behind = (np.array(neck.angles(q + s * step * rates)) for s in (1.0, -1.0))
    derivative = (ahead - behind) / (2.0 * step)
    signed = record.pan.sign * 0.7, record.tilt.sign * -0.4
    np.testing.assert_allclose(signed, derivative, atol=1e-6)


def test_a_fixed_camera_looks_at_one_point(robot):
    tree = with_camera_turned(replace(robot.tree, head=None), np.array([0.0, 1.0, 0.0]), 0.5)
    neck = Neck(tree)
    np.testing.assert_allclose(neck.range(), [[0.0, 0.0], [-0.5, -0.5]], atol=1e-12)
    assert neck.angles(robot.ready) == pytest.approx((0.0, -sin(0.5) and -0.5))
