"""Head motion within limits of rate and acceleration."""

import numpy as np

from walking.arrays import Array, Point
from walking.body import head_kernel
from walking.command import HeadTarget
from walking.parameters import CONTROL_PERIOD, HeadParameters


class Head:
    """Time-optimal motion of pan and tilt.

    Args:
        angles: initial pan and tilt [rad].
        limits: lower and upper limit of each (2, 2) [rad].
        parameters: maximum rate and acceleration.
    """

    def __init__(self, angles: Point, limits: Array, parameters: HeadParameters) -> None:
        self._position, self._velocity, self._limits = np.array(angles), np.zeros(2), limits
        motion = parameters.max_rate, parameters.max_acceleration, CONTROL_PERIOD
        self._motion = np.array(motion)

    def advance(self, target: HeadTarget) -> Point:
        """Return the setpoints of pan and tilt of this tick [rad]."""
        return head_kernel.advance(
            self._position, self._velocity, (target.pan, target.tilt), self._limits, self._motion
        )
