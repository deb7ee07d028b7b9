"""Pendulum along a planned ZMP, compiled; see `walking.pattern.robust_pattern`."""

from compilation import compiled
from walking.arrays import Array, Point

Pendulum = tuple[float, float, float, float, float, float]
"""Position x, y [m], velocity x, y [m/s], ZMP of the last tick x, y [m]."""

Tick = tuple[float, float, float, float]
"""Control tick of the pendulum, see `Lipm.tick`."""


@compiled
def follow(knots: Array, begin: int, pendulum: Pendulum, tick: Tick) -> tuple[Pendulum, int]:
    """Advance the pendulum by a tick along a plan.

    Args:
        knots: ticks since the previous knot, at `begin` the remaining ticks; x, y [m] (n, 3).
        begin: index of the next knot; beyond the last the ZMP stays.
        pendulum: present.
        tick: of the pendulum.

    Returns:
        the pendulum and the index of the next knot, a tick later.
    """
    x, y, vx, vy, zmp_x, zmp_y = pendulum
    px, py = zmp_x, zmp_y
    if begin < knots.shape[0]:
        knot = knots[begin]
        if knot[0] == 1.0:
            px, py = knot[1], knot[2]
            begin += 1
        else:
            px, py = px + (knot[1] - px) / knot[0], py + (knot[2] - py) / knot[0]
            knot[0] -= 1.0
    x, vx = _slide(x, vx, zmp_x, px, tick)
    y, vy = _slide(y, vy, zmp_y, py, tick)
    return (x, y, vx, vy, px, py), begin


@compiled
def _slide(position: float, velocity: float, before: float, after: float, tick: Tick) -> Point:
    """Return position [m] and velocity [m/s] one tick later under a linearly moving ZMP."""
    w, c, s, period = tick
    rate = (after - before) / period
    # The ZMP is a particular solution of the equation of motion.
    d, v = position - before, velocity - rate
    return after + d * c + v / w * s, rate + d * w * s + v * c
