"""Dynamics, ready posture and measures of a robot."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.body.kinematics import tree_pass
from walking.body.robot_model import dynamic_model
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.model import Link


@pytest.mark.parametrize("height", [0.19, 0.204, 0.22])
def test_the_feet_of_a_standing_robot_are_level_below_its_mass(robot, height):
    before = robot.ready.copy()
    assert robot.stand(height, 0.042) < 1e-9
    ahead = robot.com(robot.ready)[0] - robot.sole.centre
    for leg, part in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True):
        foot = leg.pose(robot.ready[part])
        assert (foot.roll, foot.pitch, foot.yaw) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
        assert foot.z == pytest.approx(leg.hip[2] - height, abs=1e-9)
        assert foot.x == pytest.approx(ahead, abs=1e-5)
    robot.ready[:] = before


def test_torque_at_rest_is_the_gradient_of_the_potential_energy(robot):
    q, rest = robot.ready, np.zeros(len(robot.names))
    torque, wrench = robot.inverse_dynamics(q, rest, rest, (0.0, 0.0))
    assert wrench[2] == pytest.approx(robot.mass * 9.81)
    for joint in range(len(robot.names)):
        step = np.zeros_like(q)
        step[joint] = 1e-6
        rise = robot.com(q + step)[2] - robot.com(q - step)[2]
        assert torque[joint] == pytest.approx(robot.mass * 9.81 * rise / 2e-6, abs=1e-5)


def assert_same_as_pinocchio(tree, seed):
    """Compare centre of mass and frames of a random posture with Pinocchio."""
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, len(tree.names))
    model = dynamic_model(tree)
    data, position = model.createData(), pin.neutral(model)
    position[[model.joints[model.getJointId(name)].idx_q for name in tree.names]] = q
    links, order = tree.links()
    poses = np.empty((len(links), 12))
    com = tree_pass(links.view(Link).reshape(-1), order, q, poses)
    expected = pin.centerOfMass(model, data, position)
    np.testing.assert_allclose(com, expected, rtol=0.0, atol=1e-12)
    for joint, name in enumerate(tree.names):
        expected = data.oMi[model.getJointId(name)]
        rotation = poses[joint, :9].reshape(3, 3)
        np.testing.assert_allclose(rotation, expected.rotation, rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(poses[joint, 9:], expected.translation, rtol=0.0, atol=1e-12)


@given(st.integers(0, 10**6))
def test_it_is_that_of_pinocchio_for_any_tree(robot, seed):
    """Joints in any order: a waist may follow the legs that it carries."""
    rng, n = np.random.default_rng(seed), len(robot.names)
    names = rng.permutation(n)
    parents = np.full(n, -1)
    for k in range(1, n):
        parents[names[k]] = rng.choice([-1, *names[:k]])
    axes = rng.normal(size=(n, 3))
    tree = replace(
        robot.tree,
        parents=parents,
        axes=axes / np.linalg.norm(axes, axis=1)[:, None],
        positions=rng.uniform(-0.3, 0.3, (n, 3)),
    )
    assert_same_as_pinocchio(tree, seed)
