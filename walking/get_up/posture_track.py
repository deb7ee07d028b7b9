"""Joint trajectories between postures."""

from math import ceil

import numpy as np

from walking.arrays import Array
from walking.body.robot_model import RobotModel
from walking.parameters import CONTROL_PERIOD
from walking.swing import PEAK, minimum_jerk


class PostureTrack:
    """Minimum-jerk motion of all joints within limits of angle and rate.

    Args:
        robot: joint limits.
        speed: maximum joint rate [rad/s].
        angles: initial joint angles (n,) [rad].

    Attributes:
        angles: present setpoints (n,) [rad].
    """

    def __init__(self, robot: RobotModel, speed: float, angles: Array) -> None:
        self._lower, self._upper = robot.lower, robot.upper
        self._speed = speed
        self.angles = self._within(angles)
        self._origin = self._goal = self.angles
        self._ticks, self._tick, self._last = 1, 1, 1

    @property
    def done(self) -> bool:
        """Whether the posture has been reached and held."""
        return self._tick >= self._last

    def aim(self, angles: Array, time: float, hold: float = 0.0) -> None:
        """Start a motion to a posture.

        Args:
            angles: of the posture, clipped to the joint limits (n,) [rad].
            time: of the motion, extended if a joint would be too fast [s].
            hold: time in the posture [s].
        """
        self._origin, self._goal = self.angles, self._within(angles)
        max_change = float(np.abs(self._goal - self._origin).max())
        time = max(time, PEAK * max_change / self._speed, CONTROL_PERIOD)
        self._ticks, self._tick = ceil(time / CONTROL_PERIOD), 0
        self._last = self._ticks + round(hold / CONTROL_PERIOD)

    def advance(self) -> Array:
        """Return the setpoints of the next tick (n,) [rad]."""
        self._tick += 1
        fraction = minimum_jerk(self._tick / self._ticks)
        self.angles = self._origin + fraction * (self._goal - self._origin)
        return self.angles

    def _within(self, angles: Array) -> Array:
        within: Array = np.clip(angles, self._lower, self._upper)
        return within
