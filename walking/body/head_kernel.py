"""Head motion, compiled."""

from math import sqrt

from compilation import compiled
from walking.arrays import Array, Point


@compiled
def advance(position: Array, velocity: Array, target: Point, limits: Array, motion: Array) -> Point:
    """Run one tick: time-optimal approach to the target on each axis, without overshoot.

    Args:
        position: pan and tilt, updated (2,) [rad].
        velocity: their rates, updated (2,) [rad/s].
        target: pan and tilt [rad].
        limits: lower and upper joint limit of each (2, 2) [rad].
        motion: maximum rate [rad/s] and acceleration [rad/s²], period of control [s] (3,).

    Returns:
        pan and tilt [rad].
    """
    rate, acceleration, period = motion[0], motion[1], motion[2]
    step = acceleration * period
    for axis in range(2):
        low, high = limits[axis, 0], limits[axis, 1]
        error = min(high, max(low, target[axis])) - position[axis]
        # Maximum speed from which whole ticks of braking end at the target.
        reach = step * (sqrt(0.25 + 2.0 * abs(error) / (step * period)) - 0.5)
        wanted = min(rate, reach, abs(error) / period)
        wanted = wanted if error >= 0.0 else -wanted
        velocity[axis] += min(step, max(-step, wanted - velocity[axis]))
        position[axis] += velocity[axis] * period
    return position[0], position[1]
