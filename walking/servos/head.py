"""Head motion within limits of rate and acceleration."""

import numpy as np

from walking.body import head_kernel
from walking.command import HeadTarget
from walking.parameters import CONTROL_PERIOD, HeadParameters


class Head:
    """Time-optimal motion of pan and tilt.

    Args:
        pan, tilt: initial angles [rad].
        limits: joint limits of pan and of tilt [rad].
        parameters: rate and acceleration limits.
    """

    def __init__(
        self,
        pan: float,
        tilt: float,
        limits: tuple[tuple[float, float], tuple[float, float]],
        parameters: HeadParameters,
    ) -> None:
        self._position, self._velocity = np.array([pan, tilt]), np.zeros(2)
        self._limits = np.array(limits)
        motion = parameters.max_rate, parameters.max_acceleration, CONTROL_PERIOD
        self._motion = np.array(motion)

    def advance(self, target: HeadTarget) -> tuple[float, float]:
        """Return the setpoints of pan and tilt of this tick [rad]."""
        return head_kernel.advance(
            self._position, self._velocity, (target.pan, target.tilt), self._limits, self._motion
        )
