"""Speed control against slip and short landings of the feet."""

from math import cos, sin

from walking.clamp import clamp
from walking.footsteps.stride import Velocity
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

Pose = tuple[float, float, float]
Correction = tuple[float, float]


class SpeedHold:
    """Integral correction of the velocity under a steady command, once per gait cycle.

    Displacements are summed in the present heading: a robot turns in one of two footsteps, so its
    heading at the begin of a cycle differs from the mean.

    Args:
        parameters: gain and limit.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._gain = parameters.speed_gain
        self._limit = parameters.max_speed_correction
        self._velocity: Velocity | None = None
        self._correction: Correction = (0.0, 0.0)
        self._pose: Pose | None = None
        self._displacement = (0.0, 0.0)
        self._ticks = 0
        self._whole = False

    def reset(self) -> None:
        """Discard the correction."""
        self._velocity = self._pose = None
        self._correction = (0.0, 0.0)
        self._whole = False

    def correction(
        self, pose: Pose, velocity: Velocity, *, begins: bool, disturbed: bool
    ) -> Correction:
        """Return the correction of (vx, vy) [m/s, m/s], zero until a command is steady.

        Args:
            pose: by odometry, heading unwrapped [m, m, rad].
            velocity: wanted (vx, vy, wz) [m/s, m/s, rad/s].
            begins: whether a gait cycle begins.
            disturbed: whether balance changes the footsteps.
        """
        if velocity != self._velocity:
            self.reset()
            self._velocity = velocity
        if self._pose is not None:
            self._integrate(self._pose, pose)
        self._pose = pose
        self._whole = self._whole and not disturbed
        if begins:
            if self._whole:
                self._correct(velocity)
            self._whole, self._ticks, self._displacement = True, 0, (0.0, 0.0)
        return self._correction

    def _integrate(self, start: Pose, end: Pose) -> None:
        """Add the displacement of a tick in the mean heading."""
        (x, y, yaw), (then_x, then_y, then_yaw) = end, start
        dx, dy = x - then_x, y - then_y
        middle = 0.5 * (then_yaw + yaw)
        c, s = cos(middle), sin(middle)
        forward, left = self._displacement
        self._displacement = forward + c * dx + s * dy, left + c * dy - s * dx
        self._ticks += 1

    def _correct(self, velocity: Velocity) -> None:
        time = self._ticks * CONTROL_PERIOD
        forward, left = (
            clamp(now - self._gain * (moved / time - wanted), self._limit)
            for now, moved, wanted in zip(
                self._correction, self._displacement, velocity[:2], strict=True
            )
        )
        self._correction = forward, left
