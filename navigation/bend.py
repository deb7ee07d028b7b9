"""Bends: the mean velocity of what turns while it moves."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def mean_velocity(velocity: Array, turn_rate: Array, time: float) -> Array:
    """Velocity along the chord of the arc walked within `time` (n, 2) [m/s].

    Args:
        velocity: at the start (n, 2) [m/s].
        turn_rate: of it, left positive (n,) [rad/s].
        time: [s].
    """
    half = 0.5 * time * turn_rate
    # numpy's sinc is sin(pi x)/(pi x).
    share = np.sinc(half / np.pi)
    c, s = share * np.cos(half), share * np.sin(half)
    u, v = velocity[:, 0], velocity[:, 1]
    return np.stack([c * u - s * v, s * u + c * v], axis=1)
