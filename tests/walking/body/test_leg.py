"""Legs of any build: forward kinematics against Pinocchio, inverse kinematics against both."""

from math import cos, sin

import numpy as np
import pinocchio as pin
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.body.kinematics import FootPose, Leg
from walking.body.tree import turn

SEEDS = st.integers(0, 10**6)
ORDERS = ((2, 0, 1), (1, 0, 2), (0, 2, 1))  # axes of the hip joints: z x y and two others


def random_chain(seed):
    """A leg with hip and ankle axes in any order, offset and oblique by up to 20 degrees."""
    rng = np.random.default_rng(seed)
    hip = ORDERS[rng.integers(3)]
    ankle = (1, 0) if rng.random() < 0.5 else (0, 1)
    rows, down = [], {0: 0.0, 3: -0.3, 4: -0.3, 6: -0.06}
    for k, axis in enumerate((*hip, 1, *ankle)):
        tilted = turn(np.eye(3)[rng.integers(3)], rng.uniform(-0.35, 0.35)) @ np.eye(3)[axis]
        fixed = turn(np.eye(3)[rng.integers(3)], rng.uniform(-0.1, 0.1))
        away = np.array([0.0, 0.1 if k == 0 else 0.0, down.get(k, 0.0)])
        moved = away + rng.uniform(-0.02, 0.02, 3)
        rows.append([*fixed.ravel(), *moved, *(tilted * rng.choice([-1.0, 1.0]))])
    rows.append([*np.eye(3).ravel(), 0.02, 0.01, down[6], 0.0, 0.0, 0.0])
    return np.array(rows)


def by_pinocchio(chain, angles):
    """Rotation and position of the end of a chain."""
    model = pin.Model()
    joint = 0
    for k, row in enumerate(chain[:6]):
        placement = pin.SE3(row[:9].reshape(3, 3), row[9:12])
        joint = model.addJoint(joint, pin.JointModelRevoluteUnaligned(row[12:]), placement, str(k))
    data = model.createData()
    pin.forwardKinematics(model, data, angles)
    end = data.oMi[joint] * pin.SE3(chain[6, :9].reshape(3, 3), chain[6, 9:12])
    return end.rotation, end.translation


def rotation(pose):
    cr, sr, cp, sp = cos(pose.roll), sin(pose.roll), cos(pose.pitch), sin(pose.pitch)
    cy, sy = cos(pose.yaw), sin(pose.yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


@settings(max_examples=40)
@given(SEEDS)
def test_forward_kinematics_agree_with_pinocchio(seed):
    leg = Leg.of(random_chain(seed), np.zeros(6))
    angles = np.random.default_rng(seed).uniform(-0.8, 0.8, 6)
    pose, (R, p) = leg.pose(angles), by_pinocchio(leg.chain, angles)
    np.testing.assert_allclose(rotation(pose), R, atol=1e-12)
    np.testing.assert_allclose([pose.x, pose.y, pose.z], p, atol=1e-12)


@settings(max_examples=50)
@given(SEEDS)
def test_inverse_kinematics_find_the_joints_of_any_leg(seed):
    leg = Leg.of(random_chain(seed), np.zeros(6))
    angles = leg.bent + np.random.default_rng(seed).uniform(-0.3, 0.3, 6)
    solved, error = leg.angles(leg.pose(angles))
    assert error < 1e-10
    np.testing.assert_allclose(solved, angles, atol=1e-7)  # the branch of the bent knee


def test_a_foot_out_of_reach_is_reported_with_a_finite_posture(robot):
    angles, error = robot.legs[0].angles(FootPose(0.05, 0.05, -0.30, 0.1, -0.1, 0.2))
    assert error > 1e-3
    assert np.isfinite(angles).all()
    pose = robot.legs[0].pose(angles)
    assert -0.25 < pose.z < -0.22  # nearly straight


@given(SEEDS)
def test_axes_and_origins_are_those_of_small_turns(seed):
    leg, step = Leg.of(random_chain(seed), np.zeros(6)), 1e-6
    angles = np.random.default_rng(seed).uniform(-0.5, 0.5, 6)
    axes, origins = leg.joints(angles)
    _, p = by_pinocchio(leg.chain, angles)
    for k in range(6):
        turned = angles.copy()
        turned[k] += step
        _, moved = by_pinocchio(leg.chain, turned)
        expected = np.cross(axes[k], p - origins[k])
        np.testing.assert_allclose((moved - p) / step, expected, atol=1e-5)
