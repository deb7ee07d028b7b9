from dataclasses import fields

import numpy as np
import pytest

from hsr8.scenario.fault import (
    AttitudeBias,
    EncoderFrozen,
    EncoderOffset,
    FootGain,
    FootSensorDropout,
    GyroBias,
    ImuFrozen,
)
from hsr8.world.body.sensor_faults import SensorFaults
from hsr8.world.rotation import heading, quaternion_from_yaw
from walking.body.joints import JOINT_NAMES
from walking.sensing import BodySensors

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
