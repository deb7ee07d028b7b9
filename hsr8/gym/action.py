"""Actions: numbers from -1 to 1, mapped to the limits of motion and gaze."""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.plugins.decisions import Limits
from hsr8.plugins.method import numbers, shown

Array = NDArray[np.float64]
Part = Literal["motion", "gaze"]

SIZES = {"motion": 3, "gaze": 2}


class ActionMap:
    """Map from actions to velocities and gazes.

    An action has the values (vx, vy, wz), (pan, tilt) or both in this order. From -1 to 1, a
    velocity of zero is 0, and the middle of the neck's range is 0.

    Args:
        limits: limits of motion and gaze.
        normalized: whether actions are from -1 to 1; if not, in [m/s], [rad/s] and [rad].
    """

    def __init__(self, limits: Limits, *, normalized: bool) -> None:
        speed = limits.speed
        self._velocities = np.array(
            [[-speed.vx_backward, -speed.vy, -speed.wz], [speed.vx, speed.vy, speed.wz]]
        )
        self._neck = limits.neck.T
        self._normalized = normalized

    def space(self, decides: Sequence[Part]) -> spaces.Box:
        """Return the space of the actions that decide these parts."""
        parts = {"motion": self._velocities, "gaze": self._neck}
        low, high = np.hstack([parts[part] for part in SIZES if part in decides])
        if self._normalized:
            low, high = -np.ones(len(low)), np.ones(len(high))
        return spaces.Box(low.astype(np.float32), high.astype(np.float32))

    def spaces(self, part: Part) -> tuple[spaces.Box, spaces.Box]:
        """Return the spaces of the actions that decide `part`, alone and with the other."""
        return self.space([part]), self.space(["motion", "gaze"])

    def velocity(self, action: Array) -> Array:
        """Return vx, vy and wz of an action that decides motion (3,) [m/s, m/s, rad/s]."""
        values = action[: SIZES["motion"]]
        if not self._normalized:
            return values
        velocity: Array = values * np.where(values < 0.0, -self._velocities[0], self._velocities[1])
        return velocity

    def gaze(self, action: Array) -> tuple[float, float]:
        """Return pan and tilt of an action that decides the gaze [rad]."""
        values = action[-SIZES["gaze"] :]
        if self._normalized:
            low, high = self._neck
            values = 0.5 * (low + high) + 0.5 * (high - low) * values
        pan, tilt = values.tolist()
        return pan, tilt


def clipped(action: NDArray[Any], *allowed: spaces.Box) -> Array:
    """Return the action as floats within the space of its shape.

    Raises:
        UsageError: it is not a vector of finite numbers of one of the shapes.
    """
    values = numbers(action)
    if values is not None and np.isfinite(values).all():
        for space in allowed:
            if values.shape == space.shape:
                return np.clip(values, space.low, space.high)
    expected = " or ".join(str(space.shape[0]) for space in allowed)
    raise UsageError(f"action: got {shown(action)}; expected {expected} finite numbers")
