"""Signals of a control tick: sensor readings in, joint targets out."""

from compilation.value import value
from walking.plane import Array


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
