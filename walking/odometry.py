"""Where the robot went: support-foot kinematics with the IMU's heading."""

from dataclasses import dataclass
from math import cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from walking.parameters import CONTROL_PERIOD, OdometryParameters
from walking.rotation import wrap
from walking.state import Odometry

Array = NDArray[np.float64]
RELEASED = 0.2  # share of the weight under which a foot no longer counts


@dataclass(frozen=True, slots=True)
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


class ErrorGrowth:
    """Covariance of the dead reckoning's error.

    In every tick a displacement of the robot and a turn of its heading go unseen, both
    independent of those before. As motions of the whole odometry frame they just add up.

    Args:
        parameters: how much goes unseen.
    """

    def __init__(self, parameters: OdometryParameters) -> None:
        self._forward = parameters.forward_noise**2 * CONTROL_PERIOD
        self._left = parameters.left_noise**2 * CONTROL_PERIOD
        self._turn = parameters.yaw_drift**2 * CONTROL_PERIOD
        self._xx = self._xy = self._xw = self._yy = self._yw = self._ww = 0.0

    def add(self, x: float, y: float, yaw: float, *, stepping: bool) -> None:
        """One tick at a pose [m, m, rad]."""
        self._add_turn(x, y, self._turn)
        if stepping:
            c, s = cos(yaw), sin(yaw)
            along, across = self._forward, self._left
            self._xx += c * c * along + s * s * across
            self._xy += c * s * (along - across)
            self._yy += s * s * along + c * c * across

    def jump(self, x: float, y: float, displacement: float, turn: float) -> None:
        """An unseen move at x, y: standard deviation of it per axis [m] and of its turn [rad]."""
        self._add_turn(x, y, turn * turn)
        self._xx += displacement * displacement
        self._yy += displacement * displacement

    def _add_turn(self, x: float, y: float, variance: float) -> None:
        self._xx += y * y * variance
        self._xy -= x * y * variance
        self._xw += y * variance
        self._yy += x * x * variance
        self._yw -= x * variance
        self._ww += variance

    def covariance(self) -> Array:
        """Error so far as a motion of the odometry frame (3, 3)."""
        return np.array(
            [
                [self._xx, self._xy, self._xw],
                [self._xy, self._yy, self._yw],
                [self._xw, self._yw, self._ww],
            ]
        )


class LegOdometry:
    """Dead reckoning of the robot frame.

    A foot on the floor stays where it is, so the body moves by the change of the vector
    from that foot to the body. The foot that has carried counts until the other one has taken
    over: a foot that has just landed slides while it is loaded, the one behind it does not.
    Encoder noise does not add up within a support because the changes telescope.

    Args:
        parameters: how much of the motion goes unseen.
    """

    def __init__(self, parameters: OdometryParameters) -> None:
        self._growth = ErrorGrowth(parameters)
        self._slip_share = parameters.slip_share
        self._stood: tuple[float, float] | None = None
        self._yaw: float | None = None
        self._raw_yaw = 0.0
        self._arms: tuple[tuple[float, float], tuple[float, float]] | None = None
        self._anchor = 0
        self.x = self.y = 0.0

    @property
    def yaw(self) -> float:
        """Heading since the start, unwrapped [rad]."""
        return self._yaw or 0.0

    def update(
        self,
        imu_yaw: float,
        feet: tuple[tuple[float, float], tuple[float, float]],
        load: float,
        *,
        stepping: bool,
    ) -> None:
        """One tick.

        Args:
            imu_yaw: heading of the IMU [rad].
            feet: horizontal position of the left and right foot in the robot frame [m].
            load: share of the weight on the right foot [1].
            stepping: whether the feet leave the floor.
        """
        if self._yaw is None:
            self._yaw = 0.0
        else:
            self._yaw += wrap(imu_yaw - self._raw_yaw)
        self._raw_yaw = imu_yaw
        c, s = cos(self._yaw), sin(self._yaw)
        (lx, ly), (rx, ry) = feet
        left = (s * ly - c * lx, -s * lx - c * ly)
        right = (s * ry - c * rx, -s * rx - c * ry)
        self._watch_slip(left[0] - right[0], left[1] - right[1], load)
        if self._arms is not None:
            if (load if self._anchor else 1.0 - load) < RELEASED:
                self._anchor = 1 - self._anchor
            now, before = (left, right)[self._anchor], self._arms[self._anchor]
            self.x += now[0] - before[0]
            self.y += now[1] - before[1]
            self._growth.add(self.x, self.y, self._yaw, stepping=stepping)
        self._arms = left, right

    def _watch_slip(self, x: float, y: float, load: float) -> None:
        """Feet that both carry keep their distance (x, y) unless one of them slips.

        Which of them did, nobody sees; but where feet slide against each other, the foot that
        counts has slipped as well, by a share that was measured.
        """
        if RELEASED <= load <= 1.0 - RELEASED:
            if self._stood is None:
                self._stood = x, y
        elif self._stood is not None:
            slip = hypot(x - self._stood[0], y - self._stood[1])
            self._growth.jump(self.x, self.y, self._slip_share * slip, 0.0)
            self._stood = None

    def interrupt(self, displacement: float, turn: float) -> None:
        """The robot has left its feet: what comes next starts from new footholds.

        The IMU goes on to tell the heading; where the robot is now was not seen.

        Args:
            displacement: standard deviation of the unseen move per axis [m].
            turn: standard deviation of the turn that the IMU misses [rad].
        """
        self._arms = self._stood = None
        self._growth.jump(self.x, self.y, displacement, turn)

    def pose(self) -> Odometry:
        """Pose of the robot frame in the odometry frame."""
        return Odometry(x=self.x, y=self.y, yaw=self.yaw, covariance=self._growth.covariance())
