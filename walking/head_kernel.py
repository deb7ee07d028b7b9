"""The head follows its target as fast as its rate and acceleration limits allow, compiled."""

from math import sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Pair = tuple[float, float]


@njit(cache=True)
def advance(
    position: Array,
    velocity: Array,
    target: Pair,
    limits: tuple[Pair, Pair],
    law: tuple[float, float, float],
) -> Pair:
    """One tick: on either axis the fastest approach that can still stop at the target.

    Args:
        position: pan and tilt, brought up to date (2,) [rad].
        velocity: their rates, brought up to date (2,) [rad/s].
        target: pan and tilt [rad].
        limits: lower and upper limit of either [rad].
        law: rate [rad/s], acceleration [rad/s²], period of control [s].

    Returns:
        pan and tilt [rad].
    """
    rate, acceleration, period = law
    step = acceleration * period
    for axis in range(2):
        low, high = limits[axis]
        error = min(high, max(low, target[axis])) - position[axis]
        # Largest speed from which whole ticks of braking still end at the target.
        reach = step * (sqrt(0.25 + 2.0 * abs(error) / (step * period)) - 0.5)
        wanted = min(rate, reach, abs(error) / period)
        wanted = wanted if error >= 0.0 else -wanted
        velocity[axis] += min(step, max(-step, wanted - velocity[axis]))
        position[axis] += velocity[axis] * period
    return position[0], position[1]
