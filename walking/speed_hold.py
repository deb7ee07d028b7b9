"""Walking as fast as told, though the feet slide and land short of the plan."""

from math import cos, sin

from walking.parameters import CONTROL_PERIOD, StabilizerParameters
from walking.stride import Velocity

Pose = tuple[float, float, float]
Correction = tuple[float, float]


class SpeedHold:
    """Velocity that makes up for what the odometry finds missing of a steady command.

    Args:
        parameters: gain and limit.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._gain = parameters.speed_gain
        self._limit = parameters.speed_correction
        self._velocity: Velocity | None = None
        self._correction: Correction = (0.0, 0.0)
        self._start: Pose | None = None
        self._ticks = 0

    def rest(self) -> None:
        """Forget everything."""
        self._velocity = self._start = None
        self._correction = (0.0, 0.0)

    def correction(
        self, pose: Pose, velocity: Velocity, *, begins: bool, disturbed: bool
    ) -> Correction:
        """Velocity to add, forward and left [m/s, m/s]: none until a command is steady.

        Args:
            pose: of the robot by odometry, its heading unwrapped [m, m, rad].
            velocity: wanted (forward, left, turn) [m/s, m/s, rad/s].
            begins: whether a cycle of two footsteps does.
            disturbed: whether balance has a say in the footsteps.
        """
        if velocity != self._velocity:
            self.rest()
            self._velocity = velocity
        self._ticks += 1
        if disturbed:
            self._start = None
        if begins:
            if self._start is not None:
                self._learn(self._start, pose, velocity)
            self._start, self._ticks = pose, 0
        return self._correction

    def _learn(self, start: Pose, end: Pose, velocity: Velocity) -> None:
        dx, dy = end[0] - start[0], end[1] - start[1]
        half = 0.5 * (end[2] - start[2])
        c, s = cos(start[2] + half), sin(start[2] + half)
        # Along the chord of the arc; the arc is longer.
        time = self._ticks * CONTROL_PERIOD * (sin(half) / half if half else 1.0)
        found = (c * dx + s * dy) / time, (c * dy - s * dx) / time
        forward, left = (
            min(self._limit, max(-self._limit, now - self._gain * (speed - wanted)))
            for now, speed, wanted in zip(self._correction, found, velocity[:2], strict=True)
        )
        self._correction = forward, left
