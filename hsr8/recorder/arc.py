"""Velocity between two poses of a robot that sways as it walks."""

from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SMALLEST = 1e-9  # half a turn so small that the arc is straight [rad]


def mean_velocity(start: Array, end: Array, time: float) -> Array:
    """Velocity in the robot frame (3,) that leads from one pose (3,) to another in `time` [s].

    The way between is taken for an arc walked at constant velocity; headings are unwrapped.
    """
    dx, dy, turn = (end - start).tolist()
    half = 0.5 * turn
    # The chord of the arc points half the turn away from the heading and is shorter than it.
    arc = half / sin(half) if SMALLEST < abs(half) < pi else 1.0
    c, s = cos(start[2] + half), sin(start[2] + half)
    return np.array([arc * (c * dx + s * dy), arc * (c * dy - s * dx), turn]) / time
