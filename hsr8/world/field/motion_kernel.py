"""Where movers are that go straight, and how fast, compiled.

A lane is where a mover's way begins x, y [m]; its direction x, y; the speed along it [m/s]; its
length, infinite where nobody turns about [m]; and how much of it is behind the mover at time zero
[m]; each for all movers.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Lanes = tuple[Array, Array, Array, Array, Array]


@njit(cache=True)
def positions(times: Array, lanes: Lanes) -> Array:
    """Where they are at some times [s] (times, movers, 2) [m]."""
    origin, way, speed, length, offset = lanes
    found = np.empty((len(times), len(speed), 2))
    for k in range(len(times)):
        for mover in range(len(speed)):
            there_and_back = 2.0 * length[mover]
            gone = np.mod(offset[mover] + speed[mover] * times[k], there_and_back)
            along = min(gone, there_and_back - gone)
            found[k, mover, 0] = origin[mover, 0] + along * way[mover, 0]
            found[k, mover, 1] = origin[mover, 1] + along * way[mover, 1]
    return found


@njit(cache=True)
def velocities(time: float, lanes: Lanes) -> Array:
    """How fast they are at a time [s] (movers, 2) [m/s]."""
    _, way, speed, length, offset = lanes
    found = np.empty((len(speed), 2))
    for mover in range(len(speed)):
        gone = np.mod(offset[mover] + speed[mover] * time, 2.0 * length[mover])
        rate = speed[mover] if gone < length[mover] else -speed[mover]
        found[mover, 0], found[mover, 1] = rate * way[mover, 0], rate * way[mover, 1]
    return found
