"""Signals of walking: sensor readings in; joint targets out, and the published state."""

from enum import StrEnum

from compilation.value import value
from walking.command import CommandLimits
from walking.estimate.odometry import Odometry
from walking.plan.footsteps import Foothold
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


class Phase(StrEnum):
    """Support phase, or getting up or fallen after a fall."""

    STANDING = "standing"
    DOUBLE_SUPPORT = "double"
    LEFT_SUPPORT = "left"
    RIGHT_SUPPORT = "right"
    GETTING_UP = "up"
    FALLEN = "fallen"

    @property
    def down(self) -> bool:
        """Whether the robot is off its feet: odometry and camera pose are invalid."""
        return self in (Phase.GETTING_UP, Phase.FALLEN)


@value
class HeadCameraPose:
    """Pose of the head camera in the robot frame R, from encoders and IMU.

    Attributes:
        rotation: R_RC, columns are the camera's right, down and forward axes (3, 3).
        position: p_RC (3,) [m]; z is the height above the floor.
        pan, tilt: measured direction of the optical axis in the base frame [rad].
        pan_rate, tilt_rate: measured rates of the head joints [rad/s].
        yaw_rate: measured yaw rate of the trunk [rad/s].
    """

    rotation: Array
    position: Array
    pan: float
    tilt: float
    pan_rate: float = 0.0
    tilt_rate: float = 0.0
    yaw_rate: float = 0.0

    @property
    def turn_rate(self) -> float:
        """Rate of the camera: the larger of those of its pan and its tilt [rad/s]."""
        return max(abs(self.pan_rate + self.yaw_rate), abs(self.tilt_rate))


@value
class Balance:
    """Planned and measured balance in the odometry frame.

    Attributes:
        com: planned centre of mass (2,) [m].
        dcm: measured divergent component of motion (2,) [m].
        support: corners of the planned support polygon, counter-clockwise (n, 2) [m].
        zmp_depth: distance of the planned ZMP from its edge, negative outside [m].
        feet: references of the left and right foot: x, y, height above the floor [m], yaw [rad]
            (2, 4).
        capture: shift of the landing by the capture step (2,) [m].
    """

    com: Array
    dcm: Array
    support: Array
    zmp_depth: float
    feet: Array
    capture: Array


@value
class WalkingState:
    """State of the walking engine after a tick.

    Attributes:
        phase: gait phase.
        odometry: pose of R in the odometry frame.
        camera: estimated pose of the head camera.
        applied_velocity: velocity (vx, vy, wz) that the footsteps follow (3,) [m/s, m/s, rad/s].
        footsteps: planned footholds, the support foot first.
        zmp: planned zero-moment point, odometry frame (2,) [m].
        dcm: planned divergent component of motion, odometry frame (2,) [m].
        com: measured centre of mass, odometry frame (2,) [m].
        roll, pitch: measured attitude of the trunk [rad].
        step_count: number of completed steps.
        fallen: whether the robot believes that it has fallen.
        balance: planned and measured motion in detail.
        command_limits: how the last command was limited.
    """

    phase: Phase
    odometry: Odometry
    camera: HeadCameraPose
    applied_velocity: Array
    footsteps: tuple[Foothold, ...]
    zmp: Array
    dcm: Array
    com: Array
    roll: float
    pitch: float
    step_count: int
    fallen: bool
    balance: Balance
    command_limits: CommandLimits | None = None
