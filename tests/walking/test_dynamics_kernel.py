"""The compiled dynamics against Pinocchio, and against the same in plain Python."""

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking import dynamics_kernel
from walking.bodies import bodies_of
from walking.joints import JOINT_NAMES
from walking.parameters import CONTROL_PERIOD

LEGS = ((0.0, 0.037, -0.02, 0.1, 0.1, 0.03), (0.0, -0.037, -0.02, 0.1, 0.1, 0.03))
SEEDS = st.integers(0, 10**6)
ANKLES = (54.0, 20.0, 25.0, 0.1)


def crooked(seed, links=8):
    """A tree with joints about any axes and bodies of any shape, as Pinocchio has it."""
    rng, model = np.random.default_rng(seed), pin.Model()
    root = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root")
    model.addJointFrame(root)
    model.appendBodyToJoint(root, pin.Inertia.Random(), pin.SE3.Identity())
    for k in range(links):
        axis = rng.normal(size=3)
        joint = pin.JointModelRevoluteUnaligned(axis / np.linalg.norm(axis))
        parent = root + int(rng.integers(k + 1))
        own = model.addJoint(parent, joint, pin.SE3.Random(), f"j{k}")
        model.addJointFrame(own)
        model.appendBodyToJoint(own, pin.Inertia.Random(), pin.SE3.Random())
    model.armature = np.concatenate([np.zeros(6), rng.uniform(0.0, 1.0, links)])
    return model, [f"j{k}" for k in range(links)]


def both(model, names, seed):
    """Torques, wrench and mass centre, here and by Pinocchio."""
    rng, n = np.random.default_rng(seed), len(names)
    angles, rates, changes = rng.normal(0.0, 1.0, (3, n))
    q, v, a = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
    joints = [model.joints[model.getJointId(name)] for name in names]
    q[[j.idx_q for j in joints]] = angles
    where = [j.idx_v for j in joints]
    v[where], a[where] = rates, changes
    a[:2] = 0.3, -0.2
    data, torques = model.createData(), np.empty(n)
    expected = pin.rnea(model, data, q, v, a)
    force, moment, com = dynamics_kernel.forces(
        bodies_of(model, names), angles, rates, changes, (0.3, -0.2, 9.81), torques
    )
    centre = pin.centerOfMass(model, data, q, False)
    return [*torques, *force, *moment, *com], [*expected[where], *expected[:6], *centre]


@given(SEEDS)
def test_the_robot_moves_as_pinocchio_says(robot, seed):
    found, expected = both(robot._model, JOINT_NAMES, seed)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12)


@settings(max_examples=20)
@given(SEEDS)
def test_any_tree_moves_as_pinocchio_says(seed):
    found, expected = both(*crooked(seed), seed)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


def test_joints_that_are_not_named_are_stiff(robot):
    model, names = crooked(3)
    named = [name for name in names if name != "j7"]
    stiff = pin.buildReducedModel(model, [model.getJointId("j7")], pin.neutral(model))
    np.testing.assert_allclose(bodies_of(model, named), bodies_of(stiff, named), atol=1e-12)


def test_a_joint_that_is_no_hinge_or_comes_too_early_is_an_error(robot):
    with pytest.raises(ValueError, match="'l_hip_roll' is no hinge on one named before"):
        bodies_of(robot._model, JOINT_NAMES[1::-1])
    model = pin.Model()
    root = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "root")
    model.addJoint(root, pin.JointModelPZ(), pin.SE3.Identity(), "slide")
    with pytest.raises(ValueError, match="'slide' is no hinge"):
        bodies_of(model, ["slide"])


@settings(max_examples=10)
@given(SEEDS)
def test_compiled_the_motion_is_what_it_says(plainly, robot, seed):
    rng, outcomes = np.random.default_rng(seed), []
    angles, rates, changes = rng.normal(0.0, 1.0, (3, 26))
    for call in (dynamics_kernel.forces, lambda *a: plainly(dynamics_kernel, "forces", *a)):
        torques = np.zeros(26)
        told = call(robot.bodies, angles, rates, changes, (0.1, 0.2, 9.81), torques)
        outcomes.append([*torques, *(v for part in told for v in part)])
    np.testing.assert_allclose(*outcomes, rtol=0.0, atol=1e-11)


def test_rates_are_quotients_of_differences():
    rng = np.random.default_rng(1)
    angles = rng.uniform(-0.1, 0.1, (3, 26))
    before, velocity, acceleration = angles[0].copy(), np.zeros(26), np.zeros(26)
    for now in angles[1:]:
        law = (0.5, 1000.0, CONTROL_PERIOD)
        dynamics_kernel.follow(now, before, velocity, acceleration, law)
    np.testing.assert_allclose(velocity, (angles[2] - angles[1]) / CONTROL_PERIOD)
    np.testing.assert_array_equal(before, angles[2])
    second = 0.5 * np.diff(angles, n=2, axis=0)[0] / CONTROL_PERIOD**2
    np.testing.assert_allclose(acceleration, second.clip(-1000.0, 1000.0))


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.sampled_from([0.0, 0.3, 1.0]))
def test_offsets_are_torques_and_rates_over_stiffness(plainly, robot, seed, load):
    rng = np.random.default_rng(seed)
    position, before, rates = rng.uniform(-0.5, 0.5, (3, 26))
    law = (0.5, 1000.0, CONTROL_PERIOD)
    servos = (rng.uniform(0.01, 0.1, 26), rng.uniform(0.0, 0.1, 26))
    pelvis = (*rng.uniform(-0.1, 0.1, 2).tolist(), 0.0)
    soles, balance = ((0.01, 0.04), (0.02, -0.04)), ((0.1, -0.2), (0.0, 0.0), (0.0, 0.0, 0.0))
    outcomes = []
    for call in (dynamics_kernel.offsets, lambda *a: plainly(dynamics_kernel, "offsets", *a)):
        own, velocity = before.copy(), rates.copy()
        told = (pelvis, (0.1, 0.2, 9.81), law, servos, soles, load, LEGS, 0.22, balance, ANKLES)
        found, com = call(robot.bodies, position, own, velocity, *told)
        outcomes.append([*found, *own, *velocity, *com])
    np.testing.assert_allclose(*outcomes, rtol=1e-11, atol=1e-11)
    acceleration, torques = np.empty(26), np.empty(26)
    dynamics_kernel.follow(position, before, rates, acceleration, law)
    asked = (position, rates, acceleration, (0.1, 0.2, 9.81), torques)
    dynamics_kernel.forces(robot.bodies, *asked)
    unloaded = slice(0, 6) if load == 1.0 else slice(12, 26)
    expected = torques * servos[0] + rates * servos[1]
    np.testing.assert_allclose(found[unloaded], expected[unloaded], rtol=0.0, atol=1e-9)
    shares = [abs(found - expected)[part].max() for part in (slice(0, 6), slice(6, 12))]
    assert [share > 1e-6 for share in shares] == [load < 1.0, load > 0.0]
