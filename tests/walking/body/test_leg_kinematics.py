"""Closed-form leg kinematics against Pinocchio."""

from math import cos, sin

import numpy as np
import pytest

from walking.body.joints import LEFT_LEG, RIGHT_LEG
from walking.body.leg_kernel import support_torques
from walking.body.leg_kinematics import FootPose, foot_pose, leg_angles

LEGS = [(0, LEFT_LEG, "l_foot"), (1, RIGHT_LEG, "r_foot")]


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


def random_legs(robot, part, count):
    rng = np.random.default_rng(3)
    for _ in range(count):
        q = robot.ready.copy()
        q[part] = rng.uniform(robot.lower[part], robot.upper[part])
        q[part.start + 3] = rng.uniform(0.05, 2.2)  # a straight knee has no unique inverse
        q[part.start + 4] = rng.uniform(-0.8, 0.5)
        yield q


@pytest.mark.parametrize(("side", "part", "frame"), LEGS)
def test_forward_kinematics_agree_with_pinocchio(robot, side, part, frame):
    for q in random_legs(robot, part, 200):
        pose = foot_pose(robot.legs[side], tuple(q[part].tolist()))
        R, p = robot.frame_pose(frame, q)
        np.testing.assert_allclose(rotation(pose), R, atol=1e-9)
        np.testing.assert_allclose([pose.x, pose.y, pose.z], p, atol=1e-9)


@pytest.mark.parametrize(("side", "part", "frame"), LEGS)
def test_inverse_kinematics_reach_the_pose_in_pinocchio(robot, side, part, frame):
    for q in random_legs(robot, part, 200):
        R, p = robot.frame_pose(frame, q)
        angles, reached = leg_angles(
            robot.legs[side], foot_pose(robot.legs[side], tuple(q[part].tolist()))
        )
        q[part] = angles
        R_again, p_again = robot.frame_pose(frame, q)
        assert reached
        np.testing.assert_allclose(R_again, R, atol=1e-9)
        np.testing.assert_allclose(p_again, p, atol=1e-9)


def test_a_foot_out_of_reach_is_reported_and_keeps_its_orientation(robot):
    pose = FootPose(0.05, 0.05, -0.30, 0.1, -0.1, 0.2)
    angles, reached = leg_angles(robot.legs[0], pose)
    again = foot_pose(robot.legs[0], angles)
    assert not reached
    np.testing.assert_allclose(rotation(again), rotation(pose), atol=1e-9)
    assert angles[3] == 0.0


@pytest.mark.parametrize("force", [(0.0, 0.0, 30.0), (8.0, -5.0, 30.0)])
def test_support_torques_are_the_virtual_work_of_the_force(robot, force):
    # The joints do as much work on the foot as the floor takes, the base held still.
    leg, angles, step = robot.legs[0], (0.2, -0.1, -0.6, 1.2, -0.5, 0.08), 1e-6
    foot = foot_pose(leg, angles)
    torques = support_torques(leg.row, angles, (foot.x, foot.y, foot.z), force)
    for k in range(6):
        ends = []
        for sign in (1.0, -1.0):
            moved = list(angles)
            moved[k] += sign * step
            pose = foot_pose(leg, tuple(moved))
            ends.append(np.array([pose.x, pose.y, pose.z]))
        motion = (ends[0] - ends[1]) / (2.0 * step)
        assert torques[k] == pytest.approx(-np.dot(force, motion), abs=1e-6)
