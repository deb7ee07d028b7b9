"""Compiled mean velocity of a mover that turns at a constant rate."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]


@compiled
def mean_velocity(velocity: Array, turn_rate: Array, time: float) -> Array:
    """Return the velocity along the chord of the arc covered in `time` (n, 2) [m/s].

    Args:
        velocity: at the start (n, 2) [m/s].
        turn_rate: of the velocity, left positive (n,) [rad/s].
        time: [s].
    """
    mean = np.empty_like(velocity)
    for i in range(len(turn_rate)):
        half = 0.5 * time * turn_rate[i]
        ratio = sin(half) / half if half != 0.0 else 1.0
        c, s = ratio * cos(half), ratio * sin(half)
        u, v = velocity[i, 0], velocity[i, 1]
        mean[i, 0], mean[i, 1] = c * u - s * v, s * u + c * v
    return mean
