"""Mean velocity between two poses."""

from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STRAIGHT = 1e-9  # half turn below which the arc is a straight line [rad]


def mean_velocity(start: Array, end: Array, time: float) -> Array:
    """Return the constant velocity in the robot frame (3,) between two poses (3,) in `time` [s].

    The path is an arc; the headings must be unwrapped.
    """
    dx, dy, turn = (end - start).tolist()
    half = 0.5 * turn
    # The chord deviates from the heading by half the turn and is shorter than the arc.
    arc = half / sin(half) if STRAIGHT < abs(half) < pi else 1.0
    c, s = cos(start[2] + half), sin(start[2] + half)
    return np.array([arc * (c * dx + s * dy), arc * (c * dy - s * dx), turn]) / time
