"""Signals of a control tick: sensor readings in, joint targets out."""

from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

from walking.plane import Array

T = TypeVar("T")


@dataclass_transform(eq_default=False, frozen_default=True)
def value(cls: type[T]) -> type[T]:
    """Make an immutable dataclass with slots; values compare by identity.

    Only the type checker forbids assignment: a check at run time makes the constructor
    ten times as slow.
    """
    return dataclass(slots=True, eq=False)(cls)


@dataclass_transform(frozen_default=True)
def comparable_value(cls: type[T]) -> type[T]:
    """Make a value that compares by content; for fields without arrays."""
    return dataclass(slots=True)(cls)


@value
class BodySensors:
    """Reading of all body sensors at the start of a control tick.

    Attributes:
        joint_position: encoder angles in the order of ``RobotTree`` (n,) [rad].
        joint_velocity: encoder rates in the same order (n,) [rad/s].
        gyro: angular velocity of the trunk in the IMU frame (3,) [rad/s].
        accelerometer: specific force in the IMU frame (3,) [m/s²]; used by the filter of
            `orientation` only.
        orientation: attitude reported by the IMU's filter, quaternion w-x-y-z (4,); roll and
            pitch are absolute, yaw drifts.
        foot_force: normal force under front-left, front-right, back-left and
            back-right pad of the left and the right foot (2, 4) [N].
    """

    joint_position: Array
    joint_velocity: Array
    gyro: Array
    accelerometer: Array
    orientation: Array
    foot_force: Array


@value
class JointTargets:
    """Setpoints of the position servos for one control tick.

    The setpoint is the desired angle plus a feed-forward offset for the compliance of the servo
    under its expected load (gravity, velocity lag), within the range of the joint. A body without
    dynamics follows `position` alone.

    Attributes:
        position: desired joint angles, order of ``RobotTree`` (n,) [rad].
        setpoint: sent to the servos (n,) [rad].
    """

    position: Array
    setpoint: Array
