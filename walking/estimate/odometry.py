"""Dead reckoning from support-foot kinematics and the heading of the IMU.

The stance foot is fixed, so the body moves by the change of the vector from that foot to the body.
The old stance foot is used until the weight has shifted: a foot slides while it is loaded after
touchdown, the one behind it does not. Encoder noise does not accumulate within a support because
the changes telescope. Every tick adds an independent unmeasured displacement and turn. As motions
of the odometry frame they simply add up.
"""

from math import cos, pi, sin

import numpy as np

from compilation import compiled
from compilation.record import records
from compilation.value import value
from walking.data import DeadReckoning
from walking.parameters import CONTROL_PERIOD, OdometryParameters
from walking.plane import Array, Point, norm

RELEASED = 0.2  # load fraction below which a foot is not the stance foot [1]


@value
class Odometry:
    """Pose of the robot frame R in the odometry frame, which drifts.

    Attributes:
        x, y: position [m].
        yaw: heading [rad], unwrapped.
        covariance: covariance of the error since the start, as displacement and turn of the
            odometry frame about its origin (3, 3) [m², m rad, rad²]. There the errors of successive
            intervals add up; `increment` extracts that of one interval.
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
        covariance: covariance of its error (3, 3), independent of other intervals.
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
    """Dead reckoning of the robot frame, see this module.

    Args:
        parameters: unmeasured motion.

    Attributes:
        records: state and constants, see `DeadReckoning` (1,).
    """

    def __init__(self, parameters: OdometryParameters) -> None:
        self.records = records(DeadReckoning)
        self._state = state = self.records[0]
        state.forward_variance = parameters.forward_noise**2 * CONTROL_PERIOD
        state.lateral_variance = parameters.lateral_noise**2 * CONTROL_PERIOD
        state.yaw_variance = parameters.yaw_drift**2 * CONTROL_PERIOD
        state.slip_ratio = parameters.slip_ratio

    @property
    def yaw(self) -> float:
        """Heading in the odometry frame, unwrapped [rad]."""
        return float(self._state.yaw)

    def slip(self, displacement: float) -> None:
        """Add an unmeasured slip of the feet: standard deviation per axis [m]."""
        add_motion(self._state, displacement, 0.0)

    def interrupt(self, displacement: float, turn: float) -> None:
        """Restart from new footholds after an unmeasured motion; the heading is that of the IMU.

        Args:
            displacement: standard deviation of the motion per axis [m].
            turn: standard deviation of the error of the IMU's yaw [rad].
        """
        self._state.placed = self._state.sliding = False
        add_motion(self._state, displacement, turn)

    def pose(self) -> Odometry:
        """Return the pose of the robot frame in the odometry frame."""
        s = self._state
        xx, xy, xw, yy, yw, ww = s.xx, s.xy, s.xw, s.yy, s.yw, s.ww
        covariance = np.array([[xx, xy, xw], [xy, yy, yw], [xw, yw, ww]])
        return Odometry(float(s.x), float(s.y), float(s.yaw), covariance)


@compiled
def reckon(
    odometry: DeadReckoning, heading: float, feet: tuple[Point, Point], load: float, stepping: bool
) -> None:
    """Run one tick of dead reckoning.

    Args:
        odometry: changed.
        heading: heading of the IMU [rad].
        feet: horizontal position of the left and right foot in the robot frame [m].
        load: load fraction of the right foot [1].
        stepping: whether a footstep is under way.
    """
    o = odometry
    if o.yaw_known:
        o.yaw += (heading - o.imu_yaw + pi) % (2.0 * pi) - pi
    o.yaw_known, o.imu_yaw = True, heading
    c, s = cos(o.yaw), sin(o.yaw)
    (lx, ly), (rx, ry) = feet
    left_x, left_y = s * ly - c * lx, -s * lx - c * ly
    right_x, right_y = s * ry - c * rx, -s * rx - c * ry
    _watch_slip(o, left_x - right_x, left_y - right_y, load)
    if o.placed:
        if (load if o.right_stance else 1.0 - load) < RELEASED:
            o.right_stance = not o.right_stance
        if o.right_stance:
            o.x += right_x - o.right_x
            o.y += right_y - o.right_y
        else:
            o.x += left_x - o.left_x
            o.y += left_y - o.left_y
        _add_turn(o, o.yaw_variance)
        if stepping:
            along, across = o.forward_variance, o.lateral_variance
            o.xx += c * c * along + s * s * across
            o.xy += c * s * (along - across)
            o.yy += s * s * along + c * c * across
    o.placed = True
    o.left_x, o.left_y, o.right_x, o.right_y = left_x, left_y, right_x, right_y


@compiled
def add_motion(odometry: DeadReckoning, displacement: float, turn: float) -> None:
    """Add an unmeasured motion: standard deviation per axis [m] and of the yaw [rad]."""
    _add_turn(odometry, turn * turn)
    odometry.xx += displacement * displacement
    odometry.yy += displacement * displacement


@compiled
def _add_turn(odometry: DeadReckoning, variance: float) -> None:
    """Add an unmeasured turn about the present position [rad²]."""
    o, x, y = odometry, odometry.x, odometry.y
    o.xx += y * y * variance
    o.xy -= x * y * variance
    o.xw += y * variance
    o.yy += x * x * variance
    o.yw -= x * variance
    o.ww += variance


@compiled
def _watch_slip(odometry: DeadReckoning, x: float, y: float, load: float) -> None:
    """Add the slip of a double support to the covariance.

    A change of the distance (x, y) between the feet is slip of either foot; the slip of the stance
    foot is a fixed ratio of it, determined by experiment.
    """
    o = odometry
    if RELEASED <= load <= 1.0 - RELEASED:
        if not o.sliding:
            o.sliding, o.apart_x, o.apart_y = True, x, y
    elif o.sliding:
        add_motion(o, o.slip_ratio * norm(x - o.apart_x, y - o.apart_y), 0.0)
        o.sliding = False
