"""The reaction of the swinging legs on the pelvis, compiled; see `walking.swing_reaction`."""

from math import cos, exp, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

Moment = tuple[float, float, float, float, float, float]
"""Of a swing over a unit distance and height, at a moment of it: ∫ ω e^{-ωs} over the rest of it
of the accelerations forward, upward, and upward times the share of the distance made [1/s²]; then
those three themselves."""


@njit(cache=True)
def react(
    swings: Array,
    now: Moment,
    later: Moment,
    reaction: tuple[float, float, float],
    state: tuple[float, float, float, float],
    clock: tuple[float, float],
) -> tuple[float, float, float, float, float, float]:
    """One tick of the pelvis.

    Args:
        swings: the next one first, see `Swings` (n, 10).
        now: of the first.
        later: of the others, before they begin.
        reaction: thrust B [s²], weight K [s²/m] and knee N [s²] of a leg.
        state: offset of the pelvis x, y, and the ξ of the tick before, x, y [m].
        clock: ω [1/s], control period [s].

    Returns:
        offset x, y [m], its acceleration x, y [m/s²], ξ x, y [m].
    """
    cx, cy, before_x, before_y = state
    w, period = clock
    x = y = now_x = now_y = 0.0
    for k in range(swings.shape[0]):
        swing = swings[k]
        forward, up, both = later[0], later[1], later[2]
        if k == 0:
            forward, up, both = now[0], now[1], now[2]
        dx, dy = _moved(swing, reaction, forward, up, both)
        decay = exp(-w * period * swing[0]) if swing[0] > 0.0 else 1.0
        x -= decay * dx
        y -= decay * dy
        if k == 0 and swing[0] <= 0.0:
            now_x, now_y = _moved(swing, reaction, now[3], now[4], now[5])
    share = 1.0 - exp(-w * period)
    cx += share * (0.5 * (before_x + x) - cx)
    cy += share * (0.5 * (before_y + y) - cy)
    return cx, cy, w * w * (cx + now_x), w * w * (cy + now_y), x, y


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
