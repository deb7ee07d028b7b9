"""Setpoint offsets for load and lag, and the ankle strategy."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compilation.record import records
from walking.body.feedforward import (
    ankle_offset,
    hip_offset,
    set_motion,
    set_offsets,
    set_within_range,
    support_torque,
)
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.constants import joint_records
from walking.data import Data
from walking.parameters import CONTROL_PERIOD, GRAVITY, StabilizerParameters, WalkingParameters

SOLES = ((0.01, 0.042), (0.01, -0.042))
NONE = (0.0, 0.0)


class Feed:
    """Feed-forward of a robot with changed parameters."""

    def __init__(self, robot, make_model, **changes):
        stabilizer = replace(StabilizerParameters(), **changes)
        parameters = replace(WalkingParameters(), stabilizer=stabilizer)
        self.robot = robot.with_own_buffers()
        self.constants = make_model(parameters=parameters).robot
        self.joints = joint_records(robot, parameters)
        self.joints["angle"] = robot.ready
        legs = zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True)
        axes, origins = zip(*(leg.joints(robot.ready[part]) for leg, part in legs), strict=True)
        self.walk = np.zeros(1, Data)[0]
        self.walk.limbs.axes, self.walk.limbs.origins = axes, origins
        self.walk.body.feet["load"] = 0.5 * robot.mass * GRAVITY

    def offsets(
        self,
        angles=None,
        *,
        pelvis=(0.0, 0.0, 0.0),
        soles=SOLES,
        right_load=0.5,
        acceleration=NONE,
        shift=NONE,
        gyro=(0.0, 0.0, 0.0),
    ):
        """Offsets of all joints [rad]."""
        angles = self.robot.ready if angles is None else angles
        walk, dynamics = self.walk, self.robot.dynamics
        motion = (dynamics.q, dynamics.v, dynamics.a)
        set_motion(self.joints, angles, motion, pelvis[2], acceleration, self.constants)
        walk.limbs.pelvis, walk.limbs.load = pelvis, right_load
        walk.zmp_shift = shift
        forces = dynamics.forces()
        set_offsets(self.joints, walk, forces, np.array(gyro), soles, self.constants)
        return self.joints["offset"].copy()


@pytest.fixture
def feed(robot, make_model):
    return lambda **changes: Feed(robot, make_model, **changes)


def test_rates_are_quotients_of_differences(feed, robot):
    ahead, rng = feed(inertia_gain=0.5, velocity_ahead=0.01), np.random.default_rng(1)
    path = robot.ready + rng.uniform(-1e-3, 1e-3, (3, robot.ready.size))
    ahead.joints["angle"] = path[0]
    for angles in path[1:]:
        ahead.offsets(angles, pelvis=(1.0, 2.0, 0.0), acceleration=(0.3, -0.2))
    joints, dynamics = ahead.joints, ahead.robot.dynamics
    np.testing.assert_allclose(joints["rate"], (path[2] - path[1]) / CONTROL_PERIOD)
    np.testing.assert_array_equal(dynamics.q[joints["in_q"]], path[2])
    np.testing.assert_array_equal(dynamics.v[joints["in_v"]], joints["rate"])
    second = 0.5 * np.diff(path, n=2, axis=0)[0] / CONTROL_PERIOD**2
    limit = StabilizerParameters().max_inertia_acceleration
    first = 0.5 * (path[1] - path[0]) / CONTROL_PERIOD**2
    assert np.isfinite(first).all()
    np.testing.assert_allclose(dynamics.a[joints["in_v"]], second.clip(-limit, limit), atol=1e-8)
    assert dynamics.a[:6].tolist() == [0.3, -0.2, 0.0, 0.0, 0.0, 0.0]
    extrapolated = joints["rate"] + 0.01 * dynamics.a[joints["in_v"]]
    np.testing.assert_allclose(joints["rate_ahead"], extrapolated)


def test_the_ankle_has_the_moment_of_the_whole_body_about_it(feed, robot):
    """A body that tips sideways in slow motion: at rest over one foot, its mass next to it."""
    offset, q = feed(velocity_gain=0.0, inertia_gain=0.0).offsets(right_load=0.0), robot.ready
    ankle = robot.com(q)[1] - robot.legs[0].pose(q[LEFT_LEG]).y
    weightless = robot.inverse_dynamics(q, 0.0 * q, 0.0 * q, NONE)[0][5]
    moment = offset[5] * robot.stiffness[5] - weightless
    assert moment == pytest.approx(-robot.mass * 9.81 * ankle, rel=0.05)


def balanced(feed, right_load, shift, gyro=(0.0, 0.0, 0.0)):
    """Offsets added by the ankle strategy."""
    without = feed().offsets(right_load=right_load)
    return feed().offsets(right_load=right_load, shift=shift, gyro=gyro) - without


def test_the_ankle_torque_matches_the_shift_of_the_zmp(feed, robot):
    added = balanced(feed, 0.0, (0.02, -0.01))
    weight = robot.mass * 9.81
    # The legs lean by 2 degrees, and their ankle axes with them.
    assert added[4] * robot.stiffness[4] == pytest.approx(weight * 0.02, rel=2e-3)
    assert added[5] * robot.stiffness[5] == pytest.approx(weight * 0.01, rel=2e-3)
    # The foot in the air and all other joints keep their offsets.
    assert not np.delete(added, [4, 5]).any()


def test_the_ankles_share_the_shift_and_damp_the_gyro(feed):
    left = balanced(feed, 0.0, (0.02, -0.01), (0.3, 0.2, 0.1))
    both = balanced(feed, 0.25, (0.02, -0.01), (0.3, 0.2, 0.1))
    np.testing.assert_allclose(both[4:6], 0.75 * left[4:6])
    np.testing.assert_allclose(both[10:12], 0.25 * left[4:6])
    still = balanced(feed, 0.0, (0.02, -0.01))
    gain = StabilizerParameters().gyro_gain
    np.testing.assert_allclose((left - still)[4:6], [gain * 0.2, gain * 0.3], rtol=2e-3)


@pytest.mark.parametrize(
    ("axis", "shift", "sign"), [((0, 1, 0), (0.01, 0.0), 1), ((1, 0, 0), (0.0, 0.01), -1)]
)
def test_an_ankle_shifts_the_zmp_by_its_compliance(model, axis, shift, sign):
    rest = (np.zeros(3), 0.02, model.robot)
    offset = ankle_offset(np.array(axis, float), shift, *rest)
    assert offset == pytest.approx(sign * model.robot.weight * 0.02 * 0.01)


def test_a_hip_turns_the_trunk_against_its_tilt_and_rate(model):
    body, gain = records(Data)[0].body, model.robot.stabilizer.hip_gain
    body.roll, body.pitch = 0.1, -0.2
    still = np.zeros(3)
    assert hip_offset(np.array([1.0, 0.0, 0.0]), body, still, model.robot) == 0.1 * gain
    assert hip_offset(np.array([0.0, 1.0, 0.0]), body, still, model.robot) == -0.2 * gain
    assert hip_offset(np.array([0.0, 0.0, 1.0]), body, still, model.robot) == 0.0
    falling = np.array([0.0, -3.0, 0.0])
    assert hip_offset(np.array([0.0, 1.0, 0.0]), body, falling, model.robot) < -0.2 * gain


def test_offsets_are_those_of_the_robot_wherever_it_stands(feed):
    x, y, yaw = 0.7, -0.3, 0.4
    c, s = np.cos(yaw), np.sin(yaw)
    there = tuple((x + c * u - s * v, y + s * u + c * v) for u, v in SOLES)
    turned = [(c * u - s * v, s * u + c * v) for u, v in ((0.2, -0.1), (0.01, 0.02))]
    gyro = (0.3, 0.2, 0.1)
    moved = feed().offsets(
        pelvis=(x, y, yaw),
        soles=there,
        right_load=0.3,
        acceleration=turned[0],
        shift=turned[1],
        gyro=gyro,
    )
    here = feed().offsets(right_load=0.3, acceleration=(0.2, -0.1), shift=(0.01, 0.02), gyro=gyro)
    np.testing.assert_allclose(moved, here, rtol=0.0, atol=1e-12)


@given(st.integers(0, 10**6))
def test_support_torques_are_the_virtual_work_of_the_force(robot, seed):
    # The joints do as much work on the foot as the floor takes, the base held still.
    rng = np.random.default_rng(seed)
    leg, step = robot.legs[0], 1e-6
    angles = leg.bent + rng.uniform(-0.3, 0.3, 6)
    force = tuple((rng.uniform(-1.0, 1.0, 3) * (8.0, 8.0, 30.0)).tolist())
    foot = leg.pose(angles)
    axes, origins = leg.joints(angles)
    for k in range(6):
        ends = []
        for sign in (1.0, -1.0):
            moved = angles.copy()
            moved[k] += sign * step
            pose = leg.pose(moved)
            ends.append(np.array([pose.x, pose.y, pose.z]))
        motion = (ends[0] - ends[1]) / (2.0 * step)
        point = (foot.x, foot.y, foot.z)
        torque = support_torque(axes[k], origins[k], point, force)
        assert torque == pytest.approx(-np.dot(force, motion), abs=1e-6)


def test_soft_legs_are_stiffened_by_the_measured_angles(feed, robot, model):
    ahead, angles, measured = feed(), robot.ready, robot.ready - 0.01
    ahead.joints["offset"] = 0.0
    constants, setpoint = model.robot.copy(), np.zeros_like(angles)
    constants.stiffening = 1.5
    set_within_range(ahead.joints, angles, measured, setpoint, constants)
    np.testing.assert_allclose(setpoint[:12], angles[:12] + 0.005)
    np.testing.assert_allclose(setpoint[12:], angles[12:].clip(robot.lower[12:], robot.upper[12:]))


def test_stiffened_setpoints_stay_within_the_range_of_the_joints(feed, robot, model):
    ahead, angles = feed(), robot.upper - 0.001
    ahead.joints["offset"] = 0.0
    constants, setpoint = model.robot.copy(), np.zeros_like(angles)
    constants.stiffening = 3.0
    set_within_range(ahead.joints, angles, angles - 0.1, setpoint, constants)
    assert setpoint[:12].tolist() == robot.upper[:12].tolist()


def test_a_foot_in_the_air_carries_nothing_although_it_is_planned_to(feed):
    landed, airborne = feed(), feed()
    airborne.walk.body.feet[0].load = 0.0
    carried = landed.offsets(right_load=0.5) - airborne.offsets(right_load=0.5)
    alone = feed()
    alone.walk.body.feet["load"] = 0.0
    np.testing.assert_array_equal(carried[6:], 0.0)
    np.testing.assert_array_equal(
        airborne.offsets(right_load=0.5)[:4], alone.offsets(right_load=0.5)[:4]
    )
    assert np.abs(carried[:6]).max() > 1e-3
