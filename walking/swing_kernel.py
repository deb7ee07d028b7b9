"""The reaction of the swinging legs on the pelvis, compiled; see `walking.swing_reaction`."""

from math import cos, exp, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]


@njit(cache=True)
def profile(ticks: int, ramp: tuple[float, float, float], period: float) -> Array:
    """A swing over a unit distance and height, tick by tick.

    Args:
        ticks: from lift to landing [1].
        ramp: growth of the DCM over a tick, and weights of the ZMP at its start and its end, see
            `RampCoefficients` [1].
        period: of control [s].

    Returns:
        at every tick ∫ ω e^{-ωs} over the rest of the swing of the accelerations forward, upward,
        and upward times the share of the distance made, linear from tick to tick; then those three
        themselves (ticks + 1, 6) [1/s²].
    """
    growth, first, last = ramp
    table = np.zeros((ticks + 1, 6))
    square = (ticks * period) ** 2
    for k in range(ticks + 1):
        u = k / ticks
        rest = 1.0 - u
        moved = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
        # Of the height 64 u³ (1 - u)³.
        up = 384.0 * u * rest * (rest * rest - 3.0 * u * rest + u * u) / square
        table[k, 3] = 60.0 * u * rest * (rest - u) / square
        table[k, 4] = up
        table[k, 5] = up * moved
    for k in range(ticks - 1, -1, -1):
        for column in range(3):
            now, then = table[k, 3 + column], table[k + 1, 3 + column]
            table[k, column] = (table[k + 1, column] + first * now + last * then) / growth
    return table


@njit(cache=True)
def react(
    swings: Array,
    now: Array,
    later: Array,
    reaction: tuple[float, float, float],
    state: Array,
    clock: Point,
) -> tuple[Point, Point]:
    """One tick of the pelvis.

    Args:
        swings: the next one first, see `Swings` (n, 10).
        now: profile of the first (ticks + 1, 6).
        later: profile of the others (ticks + 1, 6).
        reaction: thrust B [s²], weight K [s²/m] and knee N [s²] of a leg.
        state: offset of the pelvis x, y, and ξ x, y, brought up to date (4,) [m].
        clock: ω [1/s], control period [s].

    Returns:
        offset x, y [m], and its acceleration x, y [m/s²].
    """
    w, period = clock
    x = y = now_x = now_y = 0.0
    for k in range(swings.shape[0]):
        swing = swings[k]
        moment = later[0]
        if k == 0:
            moment = now[min(now.shape[0] - 1, max(0, -int(swing[0])))]
        dx, dy = _moved(swing, reaction, moment[0], moment[1], moment[2])
        decay = exp(-w * period * swing[0]) if swing[0] > 0.0 else 1.0
        x -= decay * dx
        y -= decay * dy
        if k == 0 and swing[0] <= 0.0:
            now_x, now_y = _moved(swing, reaction, moment[3], moment[4], moment[5])
    share = 1.0 - exp(-w * period)
    cx = state[0] + share * (0.5 * (state[2] + x) - state[0])
    cy = state[1] + share * (0.5 * (state[3] + y) - state[1])
    state[0], state[1], state[2], state[3] = cx, cy, x, y
    return (cx, cy), (w * w * (cx + now_x), w * w * (cy + now_y))


@njit(cache=True)
def _moved(
    swing: Array, reaction: tuple[float, float, float], forward: float, up: float, both: float
) -> tuple[float, float]:
    """Move of the ZMP, `both` being the move upwards weighted by the way made [m]."""
    thrust, weight, knee = reaction[0], reaction[1] * swing[1], reaction[2] * swing[1] * up
    yaw = 0.5 * (swing[4] + swing[7])
    dx, dy = swing[5] - swing[2], swing[6] - swing[3]
    return (
        weight * (up * (swing[2] - swing[8]) + both * dx) - thrust * forward * dx - knee * cos(yaw),
        weight * (up * (swing[3] - swing[9]) + both * dy) - thrust * forward * dy - knee * sin(yaw),
    )
