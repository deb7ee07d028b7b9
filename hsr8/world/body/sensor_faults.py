"""Sensor faults: changes to the readings of encoders, IMU and foot pads."""

from collections.abc import Sequence
from dataclasses import replace

from hsr8.scenario.fault import (
    AttitudeBias,
    EncoderFrozen,
    EncoderOffset,
    Fault,
    FootGain,
    GyroBias,
    ImuFrozen,
    SensorFault,
)
from hsr8.world.rotation import quaternion_from_yaw, quaternion_product, small_rotation
from walking.parameters import CONTROL_PERIOD
from walking.sensing import BodySensors

AXES = {"roll": 0, "pitch": 1, "yaw": 2}


class SensorFaults:
    """Applies sensor faults in the order of the scenario.

    Args:
        faults: of the scenario; faults of other parts are ignored.
        names: of the robot's joints.
    """

    def __init__(self, faults: Sequence[Fault], names: Sequence[str]) -> None:
        self._names = names
        self._faults = [f for f in faults if isinstance(f, SensorFault)]
        self._frozen: dict[int, BodySensors] = {}
        self._yaw_error = 0.0

    def apply_fault(self, sensors: BodySensors, tick: int) -> BodySensors:
        """Return the readings of control tick `tick` with the faults applied."""
        for number, fault in enumerate(self._faults):
            if fault.acts(tick):
                sensors = self._with_fault(sensors, number, fault)
        if self._yaw_error:
            turned = quaternion_product(quaternion_from_yaw(self._yaw_error), sensors.orientation)
            sensors = replace(sensors, orientation=turned)
        return sensors

    def _with_fault(self, now: BodySensors, number: int, fault: SensorFault) -> BodySensors:
        if isinstance(fault, ImuFrozen | EncoderFrozen):
            return self._frozen_readings(now, self._frozen.setdefault(number, now), fault)
        if isinstance(fault, GyroBias):
            gyro = now.gyro.copy()
            gyro[AXES[fault.axis]] += fault.magnitude
            if fault.axis == "yaw":
                self._yaw_error += CONTROL_PERIOD * fault.magnitude
            return replace(now, gyro=gyro)
        if isinstance(fault, AttitudeBias):
            roll, pitch = (fault.magnitude, 0.0) if fault.axis == "roll" else (0.0, fault.magnitude)
            tilted = quaternion_product(now.orientation, small_rotation(roll, pitch))
            return replace(now, orientation=tilted)
        if isinstance(fault, EncoderOffset):
            position = now.joint_position.copy()
            position[fault.joints(self._names)] += fault.magnitude
            return replace(now, joint_position=position)
        force = now.foot_force.copy()
        force[fault.feet] *= fault.magnitude if isinstance(fault, FootGain) else 0.0
        return replace(now, foot_force=force)

    def _frozen_readings(
        self, now: BodySensors, then: BodySensors, fault: ImuFrozen | EncoderFrozen
    ) -> BodySensors:
        if isinstance(fault, ImuFrozen):
            return replace(
                now,
                gyro=then.gyro,
                accelerometer=then.accelerometer,
                orientation=then.orientation,
            )
        position, velocity = now.joint_position.copy(), now.joint_velocity.copy()
        joints = fault.joints(self._names)
        position[joints], velocity[joints] = then.joint_position[joints], 0.0
        return replace(now, joint_position=position, joint_velocity=velocity)
