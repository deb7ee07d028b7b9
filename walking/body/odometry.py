"""Dead reckoning from support-foot kinematics and the heading of the IMU."""

from math import cos, sin

import numpy as np

from walking.arrays import Array, Point
from walking.body import estimation_kernel
from walking.parameters import CONTROL_PERIOD, OdometryParameters
from walking.value import value

# Indices of xx, xy … of the covariance in the state, see `walking.body.estimation_kernel`.
COVARIANCE = np.array([[14, 15, 16], [15, 17, 18], [16, 18, 19]])


@value
class Odometry:
    """Pose of the robot frame R in the odometry frame, which drifts.

    Attributes:
        x, y: position [m].
        yaw: heading [rad], unwrapped.
        covariance: of the error since the start, as displacement and turn of the odometry frame
            about its origin (3, 3) [m², m rad, rad²]. There the errors of successive intervals add
            up; `increment` extracts that of one interval.
    """

    x: float
    y: float
    yaw: float
    covariance: Array


@value
class Increment:
    """Motion of the robot frame between two odometry readings.

    Attributes:
        motion: displacement in the robot frame of the earlier reading, and turn
            (3,) [m, m, rad].
        covariance: of its error (3, 3), independent of other intervals.
    """

    motion: Array
    covariance: Array


def increment(before: Odometry, after: Odometry) -> Increment:
    """Return the motion between two odometry readings."""
    c, s = cos(before.yaw), sin(before.yaw)
    dx, dy = after.x - before.x, after.y - before.y
    # From a turn of the odometry frame about its origin to the displacement of the robot itself.
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

    The stance foot is fixed, so the body moves by the change of the vector from that foot to the
    body. The old stance foot is used until the weight has shifted: a foot slides while it is loaded
    after touchdown, the one behind it does not. Encoder noise does not accumulate within a support
    because the changes telescope.

    Every tick adds an independent unmeasured displacement and turn. As motions of the odometry
    frame they simply add up.

    Args:
        parameters: of the unmeasured motion.

    Attributes:
        state: see `estimation_kernel` (20,).
        growth: unmeasured motion per tick, see `estimation_kernel.reckon` (4,).
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

    def advance(
        self, heading: float, feet: tuple[Point, Point], right_load: float, *, stepping: bool
    ) -> None:
        """Run one tick of dead reckoning from measurements, see `estimation_kernel.reckon`.

        Args:
            heading: of the IMU [rad].
            feet: horizontal position of the left and right foot in the robot frame [m].
            right_load: load fraction of the right foot [1].
            stepping: whether a footstep is under way.
        """
        estimation_kernel.reckon(self.state, heading, feet, right_load, stepping, self.growth)

    def slip(self, displacement: float) -> None:
        """Add an unmeasured slip of the feet: standard deviation per axis [m]."""
        estimation_kernel.jump(self.state, displacement, 0.0)

    def interrupt(self, displacement: float, turn: float) -> None:
        """Restart from new footholds after an unmeasured motion; the heading is that of the IMU.

        Args:
            displacement: standard deviation of the motion per axis [m].
            turn: standard deviation of the error of the IMU's yaw [rad].
        """
        self.state[5] = self.state[11] = 0.0
        estimation_kernel.jump(self.state, displacement, turn)

    def pose(self) -> Odometry:
        """Return the pose of the robot frame in the odometry frame."""
        x, y, yaw = self.state[:3].tolist()
        return Odometry(x=x, y=y, yaw=yaw, covariance=self.state.take(COVARIANCE))
