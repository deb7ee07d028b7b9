"""Where the robot went: support-foot kinematics with the IMU's heading."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from walking.body import estimation_kernel
from walking.parameters import CONTROL_PERIOD, OdometryParameters
from walking.value import value

Array = NDArray[np.float64]

# Where xx, xy … of the covariance are in the state, see `walking.body.estimation_kernel`.
COVARIANCE = np.array([[14, 15, 16], [15, 17, 18], [16, 18, 19]])


@value
class Odometry:
    """Pose of the robot frame R in the odometry frame, which drifts.

    Attributes:
        x, y: position [m].
        yaw: heading [rad], unwrapped.
        covariance: of the error since the start, as a displacement and a turn of the whole
            odometry frame about its origin (3, 3) [m², m rad, rad²]. The errors of successive
            stretches add up there; `increment` takes those of one stretch out again.
    """

    x: float
    y: float
    yaw: float
    covariance: Array


@value
class Increment:
    """Motion of the robot frame between two readings of the odometry.

    Attributes:
        motion: displacement in the robot frame of the earlier reading, and turn
            (3,) [m, m, rad].
        covariance: of its error (3, 3); independent of that of any other stretch.
    """

    motion: Array
    covariance: Array


def increment(before: Odometry, after: Odometry) -> Increment:
    """What the odometry says of the motion between two of its readings."""
    c, s = cos(before.yaw), sin(before.yaw)
    dx, dy = after.x - before.x, after.y - before.y
    # A turn of the odometry frame moves the robot about the frame's origin; what counts is
    # the robot's own displacement, seen from where it stood.
    to_robot = np.array(
        [
            [c, s, s * after.x - c * after.y],
            [-s, c, c * after.x + s * after.y],
            [0.0, 0.0, 1.0],
        ]
    )
    return Increment(
        motion=np.array([c * dx + s * dy, c * dy - s * dx, after.yaw - before.yaw]),
        covariance=to_robot @ (after.covariance - before.covariance) @ to_robot.T,
    )


class LegOdometry:
    """Dead reckoning of the robot frame.

    A foot on the floor stays where it is, so the body moves by the change of the vector
    from that foot to the body. The foot that has carried counts until the other one has taken
    over: a foot that has just landed slides while it is loaded, the one behind it does not.
    Encoder noise does not add up within a support because the changes telescope.

    In every tick a displacement of the robot and a turn of its heading go unseen, both
    independent of those before. As motions of the whole odometry frame they just add up.

    Args:
        parameters: how much of the motion goes unseen.

    Attributes:
        state: as `estimation_kernel` has it, whose `reckon` is a tick (20,).
        growth: what goes unseen in a tick, see `estimation_kernel.reckon` (4,).
    """

    def __init__(self, parameters: OdometryParameters) -> None:
        self.state = np.zeros(20)
        self.growth = np.array(
            [
                parameters.forward_noise**2 * CONTROL_PERIOD,
                parameters.lateral_noise**2 * CONTROL_PERIOD,
                parameters.yaw_drift**2 * CONTROL_PERIOD,
                parameters.slip_ratio,
            ]
        )

    def interrupt(self, displacement: float, turn: float) -> None:
        """The robot has left its feet: what comes next starts from new footholds.

        The IMU goes on to tell the heading; where the robot is now was not seen.

        Args:
            displacement: standard deviation of the unseen move per axis [m].
            turn: standard deviation of the turn that the IMU misses [rad].
        """
        self.state[5] = self.state[11] = 0.0
        estimation_kernel.jump(self.state, displacement, turn)

    def pose(self) -> Odometry:
        """Pose of the robot frame in the odometry frame."""
        x, y, yaw = self.state[:3].tolist()
        return Odometry(x=x, y=y, yaw=yaw, covariance=self.state.take(COVARIANCE))
