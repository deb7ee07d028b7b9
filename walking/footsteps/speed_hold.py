"""Walking as fast as told, though the feet slide and land short of the plan."""

from math import cos, sin

from walking.clamp import clamp
from walking.footsteps.stride import Velocity
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

Pose = tuple[float, float, float]
Correction = tuple[float, float]


class SpeedHold:
    """Velocity that makes up for what the odometry finds missing of a steady command.

    Velocities are those along and across the heading of the moment: a robot that turns does so
    in one of two footsteps, so its heading at the begin of a cycle is not the mean one, and the
    way of a cycle seen from there leans to the side.

    Args:
        parameters: gain and limit.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._gain = parameters.speed_gain
        self._limit = parameters.max_speed_correction
        self._velocity: Velocity | None = None
        self._correction: Correction = (0.0, 0.0)
        self._pose: Pose | None = None
        self._way = (0.0, 0.0)
        self._ticks = 0
        self._whole = False

    def rest(self) -> None:
        """Forget everything."""
        self._velocity = self._pose = None
        self._correction = (0.0, 0.0)
        self._whole = False

    def correction(
        self, pose: Pose, velocity: Velocity, *, begins: bool, disturbed: bool
    ) -> Correction:
        """Velocity to add, forward and left [m/s, m/s]: none until a command is steady.

        Args:
            pose: of the robot by odometry, its heading unwrapped [m, m, rad].
            velocity: wanted (vx, vy, wz) [m/s, m/s, rad/s].
            begins: whether a cycle of two footsteps does.
            disturbed: whether balance has a say in the footsteps.
        """
        if velocity != self._velocity:
            self.rest()
            self._velocity = velocity
        if self._pose is not None:
            self._go(self._pose, pose)
        self._pose = pose
        self._whole = self._whole and not disturbed
        if begins:
            if self._whole:
                self._learn(velocity)
            self._whole, self._ticks, self._way = True, 0, (0.0, 0.0)
        return self._correction

    def _go(self, start: Pose, end: Pose) -> None:
        """One tick of the way, seen from the robot."""
        (x, y, yaw), (then_x, then_y, then_yaw) = end, start
        dx, dy = x - then_x, y - then_y
        middle = 0.5 * (then_yaw + yaw)
        c, s = cos(middle), sin(middle)
        forward, left = self._way
        self._way = forward + c * dx + s * dy, left + c * dy - s * dx
        self._ticks += 1

    def _learn(self, velocity: Velocity) -> None:
        time = self._ticks * CONTROL_PERIOD
        forward, left = (
            clamp(now - self._gain * (way / time - wanted), self._limit)
            for now, way, wanted in zip(self._correction, self._way, velocity[:2], strict=True)
        )
        self._correction = forward, left
