"""What walking knows of itself after a tick: odometry, camera pose, gait."""

from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from walking.admission import AdmissionReport
from walking.value import value

Array = NDArray[np.float64]


class Phase(StrEnum):
    """Phase of the gait, or of a fall: getting up, or given up."""

    STANDING = "standing"
    DOUBLE_SUPPORT = "double"
    LEFT_SUPPORT = "left"
    RIGHT_SUPPORT = "right"
    GETTING_UP = "up"
    FALLEN = "fallen"

    @property
    def down(self) -> bool:
        """Whether the robot is off its feet, so that neither odometry nor camera pose hold."""
        return self in (Phase.GETTING_UP, Phase.FALLEN)


@value
class Footstep:
    """A foothold in the plan frame; in a `WalkingState`, in the odometry frame.

    Attributes:
        left: whether it is the left foot.
        x, y: position of the foot frame on the floor [m].
        yaw: direction of the foot [rad].
    """

    left: bool
    x: float
    y: float
    yaw: float

    @property
    def row(self) -> tuple[float, float, float, float]:
        """As compiled code has it: x, y, yaw, and 1 for a left foot, 0 for a right one."""
        return self.x, self.y, self.yaw, 1.0 if self.left else 0.0


def foothold(row: list[float]) -> Footstep:
    """The foothold of a row, see `Footstep.row`."""
    x, y, yaw, left = row
    return Footstep(left > 0.0, x, y, yaw)


@value
class Odometry:
    """Pose of the robot frame R in the odometry frame, which drifts.

    Attributes:
        x, y: position [m].
        yaw: heading [rad], unwrapped.
        covariance: of the error since the start, as a displacement and a turn of the whole
            odometry frame about its origin (3, 3) [m², m rad, rad²]. The errors of successive
            stretches add up there; `odometry.increment` takes those of one stretch out again.
    """

    x: float
    y: float
    yaw: float
    covariance: Array


@value
class HeadCameraPose:
    """Pose of the head camera in the robot frame R, from encoders and IMU.

    Attributes:
        rotation: R_RC, columns are the camera's right, down and forward axes (3, 3).
        position: p_RC (3,) [m]; its z is the height above the floor.
        pan: measured pan of the head [rad].
        tilt: measured tilt of the head joint [rad].
        pan_rate: measured speed of the pan [rad/s].
        tilt_rate: measured speed of the tilt [rad/s].
    """

    rotation: Array
    position: Array
    pan: float
    tilt: float
    pan_rate: float = 0.0
    tilt_rate: float = 0.0


@value
class Balance:
    """What balance is about, all of it in the odometry frame.

    Attributes:
        com: planned centre of mass of the pendulum (2,) [m].
        dcm: measured divergent component of motion, the planned one and its error (2,) [m].
        support: corners of the planned support polygon, counter-clockwise (n, 2) [m].
        zmp_depth: how far inside that polygon the planned ZMP lies, negative outside [m].
        feet: reference of the left and of the right foot: x, y, height above the floor [m]
            and direction [rad] (2, 4).
        capture: what balance adds to the landing of the swing foot (2,) [m].
    """

    com: Array
    dcm: Array
    support: Array
    zmp_depth: float
    feet: Array
    capture: Array


@value
class WalkingState:
    """Snapshot of the walking engine after a tick.

    Attributes:
        phase: gait phase.
        odometry: pose of R in the odometry frame.
        camera: estimated pose of the head camera.
        given: velocity (forward, left, turn) the engine really walks (3,) [m/s, m/s, rad/s].
        footsteps: planned footholds, the support foot first.
        zmp: planned zero-moment point in the odometry frame (2,) [m].
        dcm: planned divergent component of motion in the odometry frame (2,) [m].
        com: measured centre of mass in the odometry frame (2,) [m].
        roll, pitch: measured attitude of the trunk [rad].
        step_count: number of completed steps.
        fallen: whether the robot believes that it has fallen.
        balance: planned and measured motion in detail.
        admission: what became of the last command.
    """

    phase: Phase
    odometry: Odometry
    camera: HeadCameraPose
    given: Array
    footsteps: tuple[Footstep, ...]
    zmp: Array
    dcm: Array
    com: Array
    roll: float
    pitch: float
    step_count: int
    fallen: bool
    balance: Balance
    admission: AdmissionReport | None = None
