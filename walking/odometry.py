"""Where the robot went: support-foot kinematics with the IMU's heading."""

from math import cos, sin

from walking.rotation import wrap
from walking.state import Odometry


class LegOdometry:
    """Dead reckoning of the robot frame.

    A foot on the floor stays where it is, so the body moves by the change of the vector
    from that foot to the body; both feet count by the load they carry. Encoder noise does
    not add up within a support because the changes telescope.
    """

    def __init__(self) -> None:
        self._yaw: float | None = None
        self._raw_yaw = 0.0
        self._arms: tuple[tuple[float, float], tuple[float, float]] | None = None
        self.x = self.y = 0.0

    @property
    def yaw(self) -> float:
        """Heading since the start, unwrapped [rad]."""
        return self._yaw or 0.0

    def update(
        self, imu_yaw: float, feet: tuple[tuple[float, float], tuple[float, float]], load: float
    ) -> None:
        """One tick.

        Args:
            imu_yaw: heading of the IMU [rad].
            feet: horizontal position of the left and right foot in the robot frame [m].
            load: share of the weight on the right foot [1].
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
        if self._arms is not None:
            (plx, ply), (prx, pry) = self._arms
            rest = 1.0 - load
            self.x += rest * (left[0] - plx) + load * (right[0] - prx)
            self.y += rest * (left[1] - ply) + load * (right[1] - pry)
        self._arms = left, right

    def pose(self) -> Odometry:
        """Pose of the robot frame in the odometry frame."""
        return Odometry(x=self.x, y=self.y, yaw=self.yaw)
