"""Kinematic kernels against the kinematics of MuJoCo."""

import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.world.body import kinematic_kernel as kernel
from hsr8.world.model.index import ModelIndex


def _rotated(rng, size):
    """A unit quaternion, turned by up to `size` [rad]."""
    axis = rng.standard_normal(3)
    angle = rng.uniform(-size, size)
    return np.array([np.cos(angle / 2), *np.sin(angle / 2) * axis / np.linalg.norm(axis)])


@pytest.mark.parametrize("stance", [0, 1])
def test_the_sole_lies_flat_where_it_is_planted(world, stance):
    _, model = world()
    data, index = mujoco.MjData(model), ModelIndex.of(model, load_robot("hsr8"), 0, 0)
    rng, root = np.random.default_rng(stance), index.root_qpos
    sites = list(index.foot_sites)
    feet = model.site_bodyid[sites].astype(np.intp)
    soles = np.hstack([model.site_pos[sites], model.site_quat[sites]])
    for _ in range(20):
        data.qpos[:] = rng.uniform(-0.5, 0.5, model.nq)
        data.qpos[root : root + 7] = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
        mujoco.mj_kinematics(model, data)
        anchor, pose, other = rng.uniform(-2.0, 2.0, 3), np.empty(7), np.empty(4)
        kernel.base_pose(data.xpos, data.xquat, feet, soles, stance, anchor, pose, other)
        data.qpos[root : root + 7] = pose
        mujoco.mj_kinematics(model, data)
        positions, axes = data.site_xpos[sites], data.site_xmat[sites].reshape(2, 3, 3)
        c, s = np.cos(anchor[2]), np.sin(anchor[2])
        assert np.allclose(positions[stance], [*anchor[:2], 0.0], atol=1e-9)
        assert np.allclose(axes[stance], [[c, -s, 0], [s, c, 0], [0, 0, 1]], atol=1e-9)
        x_axis = axes[1 - stance][:, 0]
        expected = [
            *positions[1 - stance][:2],
            np.arctan2(x_axis[1], x_axis[0]),
            positions[1 - stance][2],
        ]
        assert np.allclose(other, expected, atol=1e-9)


def test_imu_motion_is_that_of_mujoco():
    rng = np.random.default_rng(0)
    for turn in (0.0, 1e-9, 0.01, 1.0, 3.0):
        step = _rotated(rng, turn)
        before = np.array([*rng.standard_normal(3), *_rotated(rng, 3.0)])
        after = before + 0.01
        mujoco.mju_mulQuat(after[3:], before[3:], step)
        expected, motion = np.empty(3), (np.empty(3), np.empty(3), np.empty(3))
        mujoco.mju_subQuat(expected, after[3:], before[3:])
        kernel.imu_motion(before, after, 0.005, *motion)
        assert np.allclose(motion[0], 0.01 / 0.005)
        assert np.allclose(motion[1], expected / 0.005, rtol=1e-6, atol=1e-8)
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, after[3:])
        assert np.allclose(motion[2], rotation.reshape(3, 3).T @ (0.0, 0.0, 9.81))


def test_the_shorter_rotation_is_used():
    before, after = np.array([0.0, 0, 0, 1, 0, 0, 0]), np.array([0.0, 0, 0, -1, 0, 0, -1e-6])
    motion = np.empty(3), np.empty(3), np.empty(3)
    kernel.imu_motion(before, after, 1.0, *motion)
    assert motion[1] == pytest.approx((0.0, 0.0, 2e-6), rel=1e-6)
