from dataclasses import fields

import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.robots.model.tree import max_torque
from hsr8.scenario.fault import (
    AttitudeBias,
    Bump,
    EncoderFrozen,
    EncoderOffset,
    FootGain,
    FootSensorDropout,
    GyroBias,
    ImuFrozen,
    LowFriction,
    MoverAppears,
    ServoDelay,
    ServoStuck,
    ServoWeak,
)
from hsr8.scenario.track import AWAY
from hsr8.world.body.faults import SensorFaults, ServoFaults, WorldFaults
from hsr8.world.body.physics import place_robot
from hsr8.world.field.layout import Layout, Obstacle, with_faults
from hsr8.world.field.motion import Shuttle
from hsr8.world.model.assembly import Optics, assemble
from hsr8.world.model.index import ModelIndex
from hsr8.world.rotation import heading, quaternion_from_yaw
from walking.body.tree import JOINT_NAMES
from walking.state import BodySensors, JointTargets

KNEE = 3


def reading(k=0, yaw=0.3):
    """Return a reading in which every number depends on `k`."""
    rng = np.random.default_rng(k)
    return BodySensors(
        joint_position=rng.normal(size=26),
        joint_velocity=rng.normal(size=26),
        gyro=rng.normal(size=3),
        accelerometer=rng.normal(size=3),
        orientation=quaternion_from_yaw(yaw),
        foot_force=rng.uniform(1.0, 2.0, (2, 4)),
    )


def changed(a, b):
    """Return the names of fields that differ."""
    return {f.name for f in fields(a) if not np.array_equal(getattr(a, f.name), getattr(b, f.name))}


def pitch(quaternion):
    w, x, y, z = quaternion
    return np.arcsin(2.0 * (w * y - z * x))


@pytest.mark.parametrize(
    ("fault", "fields_changed"),
    [
        (AttitudeBias(kind="attitude-bias", magnitude=0.1), {"orientation"}),
        (GyroBias(kind="gyro-bias", magnitude=0.1), {"gyro", "orientation"}),
        (GyroBias(kind="gyro-bias", magnitude=0.1, axis="roll"), {"gyro"}),
        (ImuFrozen(kind="imu-frozen"), {"gyro", "accelerometer", "orientation"}),
        (EncoderOffset(kind="encoder-offset", magnitude=0.1), {"joint_position"}),
        (EncoderFrozen(kind="encoder-frozen"), {"joint_position", "joint_velocity"}),
        (FootSensorDropout(kind="foot-sensor-dropout"), {"foot_force"}),
        (FootGain(kind="foot-gain", magnitude=2.0), {"foot_force"}),
    ],
    ids=lambda value: getattr(value, "kind", ""),
)
def test_a_fault_changes_its_own_sensor_alone_while_it_is_active(fault, fields_changed):
    timed = fault.model_copy(update={"start": 0.01, "duration": 0.015})
    faults, changes = SensorFaults([timed], JOINT_NAMES), []
    for tick in range(7):
        true = reading(tick, yaw=0.1 * tick)
        faulty = faults.apply_fault(true, tick)
        changes.append(changed(true, faulty))
        assert changed(true, reading(tick, yaw=0.1 * tick)) == set()  # the input is unchanged
    assert changes[:2] == [set(), set()]
    assert set().union(*changes[2:5]) == fields_changed
    left = (
        {"orientation"} if "orientation" in fields_changed and fault.kind == "gyro-bias" else set()
    )
    assert changes[5:] == [left, left]  # the yaw error remains


def test_magnitudes_have_their_unit():
    true = reading()
    faulty = SensorFaults(
        [AttitudeBias(kind="attitude-bias", magnitude=0.1)], JOINT_NAMES
    ).apply_fault(true, 0)
    assert pitch(faulty.orientation) == pytest.approx(0.1, abs=1e-3)
    faulty = SensorFaults(
        [EncoderOffset(kind="encoder-offset", magnitude=0.1, joint="l_knee")], JOINT_NAMES
    )
    difference = faulty.apply_fault(true, 0).joint_position - true.joint_position
    assert difference[KNEE] == pytest.approx(0.1)
    assert np.count_nonzero(difference) == 1
    faulty = SensorFaults(
        [FootGain(kind="foot-gain", magnitude=2.0, foot="right")], JOINT_NAMES
    ).apply_fault(true, 0)
    assert np.allclose(faulty.foot_force, true.foot_force * [[1.0], [2.0]])
    turning = SensorFaults([GyroBias(kind="gyro-bias", magnitude=0.2)], JOINT_NAMES)
    for tick in range(100):
        faulty = turning.apply_fault(true, tick)
    assert heading(faulty.orientation) - heading(true.orientation) == pytest.approx(0.1)
    assert faulty.gyro[2] - true.gyro[2] == pytest.approx(0.2)


def test_a_frozen_encoder_repeats_its_first_reading():
    faults = SensorFaults(
        [EncoderFrozen(kind="encoder-frozen", start=0.01, joint="l_knee")], JOINT_NAMES
    )
    faulty = [faults.apply_fault(reading(tick), tick) for tick in range(5)]
    for late in faulty[2:]:
        assert late.joint_position[KNEE] == reading(2).joint_position[KNEE]
        assert late.joint_velocity[KNEE] == 0.0
    assert faulty[4].joint_position[0] == reading(4).joint_position[0]


def commanded(tick):
    return JointTargets(np.full(26, float(tick)), np.full(26, 0.01 * tick))


def knees(faults, ticks=12):
    """Return the targets of the left and the right knee in every tick."""
    servos = ServoFaults(faults, JOINT_NAMES)
    applied = [servos.apply_fault(commanded(tick), tick) for tick in range(ticks)]
    assert all(t.setpoint[k] == 0.01 * t.position[k] for t in applied for k in range(26))
    return [int(t.position[KNEE]) for t in applied], [int(t.position[KNEE + 6]) for t in applied]


def test_a_stuck_servo_keeps_its_last_setpoint():
    stuck = ServoStuck(kind="servo-stuck", joint="l_knee", start=0.02, duration=0.02)
    left, right = knees([stuck])
    assert left == [0, 1, 2, 3, 3, 3, 3, 3, 8, 9, 10, 11]
    assert right == [*range(12)]


def test_delayed_setpoints_are_those_of_earlier_ticks():
    late = ServoDelay(kind="servo-delay", magnitude=0.015, start=0.01, duration=0.03)
    left, right = knees([late])
    assert left == right == [0, 1, 0, 0, 1, 2, 3, 4, 8, 9, 10, 11]


MOVERS = (
    Obstacle((1.0, 0.0), 0.08, 0.3, "blue", Shuttle((1.0, 0.0), (1.0, 1.0), 0.1)),
    Obstacle((-1.0, 0.0), 0.08, 0.3, "red", Shuttle((-1.0, 0.0), (-1.0, 1.0), 0.1)),
)
PLAIN = Layout((4.0, 4.0), MOVERS, (), (0.0, 0.0, 0.0), np.empty((0, 2)), None, False)


def world(*faults):
    """Model, data with the robot ready, and the faults in it."""
    model = assemble(load_robot("hsr8"), with_faults(PLAIN, faults), "vision", Optics(32, 24))
    data = mujoco.MjData(model)
    place_robot(model, data, load_robot("hsr8"), np.zeros(3))
    index = ModelIndex.of(model, load_robot("hsr8"), 0, 2)
    mujoco.mj_forward(model, data)
    return model, data, index, WorldFaults(model, index, faults)


def test_weak_servos_have_a_share_of_their_torque_left_and_get_it_back():
    weak = ServoWeak(kind="servo-weak", magnitude=0.25, joint="left_leg", start=0.01, duration=0.01)
    model, data, index, faults = world(weak)
    usual = model.actuator_forcerange.copy()
    for tick in range(6):
        faults.apply_fault(model, data, tick)
        faults.apply_fault(model, data, tick)  # it is the same however often it is asked
        ratio = model.actuator_forcerange[index.actuators] / usual[index.actuators]
        left = 0.25 if 2 <= tick < 4 else 1.0
        assert np.allclose(ratio[:6], left)
        assert np.allclose(ratio[6:], 1.0)


def test_a_patch_is_slippery_for_the_sole_on_it():
    (_, y), radius = (0.0, 0.045), 0.03
    model, data, index, faults = world(
        LowFriction(kind="low-friction", magnitude=0.1, position=(0.01, y), radius=radius)
    )
    faults.apply_fault(model, data, 0)
    assert model.geom_friction[list(index.foot_geoms), 0].tolist() == [0.1, 0.8]
    data.qpos[index.root_qpos] += 1.0
    faults.apply_fault(model, data, 1)
    assert model.geom_friction[list(index.foot_geoms), 0].tolist() == [0.8, 0.8]


def test_the_friction_of_a_slippery_floor_is_that_of_its_contacts():
    model, data, index, faults = world(LowFriction(kind="low-friction", magnitude=0.1, start=0.05))
    for tick, friction in ((0, 0.8), (10, 0.1)):
        faults.apply_fault(model, data, tick)
        mujoco.mj_step(model, data)
        feet = [
            c.friction[0] for c in data.contact[: data.ncon] if set(c.geom) & {*index.foot_geoms}
        ]
        assert len(feet) >= 4
        assert feet == pytest.approx([friction] * len(feet))


def test_a_bump_is_touched_while_it_acts_only():
    bump = Bump(
        kind="bump", magnitude=0.01, position=(0.0, 0.045), radius=0.1, start=0.05, duration=0.05
    )
    model, data, index, faults = world(bump)
    touched = []
    for tick in (0, 10, 20):
        faults.apply_fault(model, data, tick)
        mujoco.mj_forward(model, data)
        touched.append(bool(np.isin(data.contact.geom, index.bumps).any()))
    assert touched == [False, True, False]


def test_a_mover_appears_where_its_law_has_it_and_goes_again():
    layout = with_faults(
        PLAIN, [MoverAppears(kind="mover-appears", mover=1, start=2.0, duration=3.0)]
    )
    before, after = PLAIN.motion(), layout.motion()
    for time in (0.0, 1.9975, 2.0, 4.9975, 5.0, 9.0):
        there = 2.0 <= time < 5.0
        usual, faulty = before.positions(time), after.positions(time)
        assert np.array_equal(faulty[0], usual[0])
        assert np.allclose(faulty[1] - usual[1], (0.0 if there else AWAY, 0.0))
        assert np.array_equal(after.velocities(time)[1], before.velocities(time)[1] * there)
    assert layout.obstacles[1].position == (-1.0 + AWAY, 0.0)
    assert np.array_equal(after.top_speeds(), before.top_speeds())


def test_a_weak_servo_loses_torque_where_the_joint_states_the_limit():
    weak = ServoWeak(kind="servo-weak", joint="legs", magnitude=0.3)
    model, data, index, _ = world(weak)
    joints = model.dof_jntid[index.joint_dof]
    model.jnt_actfrclimited[joints] = 1
    model.jnt_actfrcrange[joints] = (-0.1, 0.1)
    before = max_torque(model, joints, index.actuators)
    WorldFaults(model, index, [weak]).apply_fault(model, data, 0)
    ratio = max_torque(model, joints, index.actuators) / before
    np.testing.assert_allclose(ratio, np.where(np.arange(len(joints)) < 12, 0.3, 1.0))
