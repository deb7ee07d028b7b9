"""Compensation of the swing leg's reaction, compiled; see `walking.gait.swing_reaction`."""

from math import cos, exp, sin

import numpy as np

from compilation import compiled
from walking.arrays import Array, Point, Vector
from walking.footsteps.foothold_kernel import Row, ZmpOffset

Feet = tuple[Row, Row, Row]
"""Support foot; lift-off and landing of the swing foot."""

SWING = 10  # columns of a swing


@compiled
def profile(ticks: int, ramp: Vector, period: float) -> Array:
    """Return the accelerations of a swing over unit distance and height, and their preview sums.

    Args:
        ticks: from lift-off to touchdown [1].
        ramp: growth of the DCM over a tick, and weights of the ZMP at its start and end, see
            `RampCoefficients` [1].
        period: of control [s].

    Returns:
        at every tick ∫ ω e^{-ωs} over the rest of the swing of the accelerations forward, upward,
        and upward times the distance covered, linear between ticks; then these accelerations
        (ticks + 1, 6) [1/s²].
    """
    growth, first, last = ramp
    table = np.zeros((ticks + 1, 6))
    square = ticks * period * (ticks * period)
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


@compiled
def react(
    feet: Feet,
    steps: Array,
    now: tuple[int, float, bool],
    later: tuple[int, int, float],
    zmp_offset: ZmpOffset,
    first: Array,
    others: Array,
    coefficients: Array,
    state: Array,
) -> tuple[Point, Point]:
    """Run one tick of the compensation.

    The first five arguments are those of `swings`, `first` and `others` the profiles of the first
    and of later swings (ticks + 1, 6). `coefficients` are thrust B [s²], weight K [s²/m] and knee N
    [s²] of a leg, ω [1/s] and control period [s] (5,); `state` is the offset of the pelvis x, y,
    and ξ x, y, updated (4,) [m].

    Returns:
        offset x, y [m], and its acceleration x, y [m/s²].
    """
    table = swings(feet, steps, now, later, zmp_offset)
    w, period = coefficients[3], coefficients[4]
    reaction = (coefficients[0], coefficients[1], coefficients[2])
    x = y = now_x = now_y = 0.0
    for k in range(table.shape[0]):
        swing = table[k]
        moment = others[0]
        if k == 0:
            moment = first[min(first.shape[0] - 1, max(0, -int(swing[0])))]
        dx, dy = _moved(swing, reaction, moment[0], moment[1], moment[2])
        decay = exp(-w * period * swing[0]) if swing[0] > 0.0 else 1.0
        x -= decay * dx
        y -= decay * dy
        if k == 0 and swing[0] <= 0.0:
            now_x, now_y = _moved(swing, reaction, moment[3], moment[4], moment[5])
    gain = 1.0 - exp(-w * period)
    cx = state[0] + gain * (0.5 * (state[2] + x) - state[0])
    cy = state[1] + gain * (0.5 * (state[3] + y) - state[1])
    state[0], state[1], state[2], state[3] = cx, cy, x, y
    return (cx, cy), (w * w * (cx + now_x), w * w * (cy + now_y))


@compiled
def swings(
    feet: Feet,
    steps: Array,
    now: tuple[int, float, bool],
    later: tuple[int, int, float],
    zmp_offset: ZmpOffset,
) -> Array:
    """Return the present and planned swings.

    Args:
        feet: see `Feet`.
        steps: planned footholds, first that of this footstep (n, 4).
        now: begin in ticks from now and height [m] of this footstep's swing, and whether there is
            one.
        later: begin in ticks from now of the next swing, ticks between swings, height [m].
        zmp_offset: see `ZmpOffset`.

    Returns:
        rows in order: control ticks until lift-off, negative in the air | height at mid-swing [m]
        | lift-off x, y [m], yaw [rad] | landing x, y [m], yaw [rad] | ZMP of the support foot x, y
        [m] (m, 10).
    """
    support, origin, landing = feet
    table = np.empty((steps.shape[0], SWING))
    row = 0
    if now[2]:
        _swing(table[row], now[0], now[1], origin, landing, _under(support, zmp_offset))
        row += 1
    begin = later[0]
    for k in range(1, steps.shape[0]):
        step = (steps[k, 0], steps[k, 1], steps[k, 2], steps[k, 3])
        _swing(table[row], begin, later[2], support, step, _under(landing, zmp_offset))
        support, landing = landing, step
        begin += later[1]
        row += 1
    return table[:row]


@compiled
def _moved(swing: Array, reaction: Vector, forward: float, up: float, both: float) -> Point:
    """Return the shift of the ZMP [m]; `both` is `up` weighted by the distance covered."""
    thrust, weight, knee = reaction[0], reaction[1] * swing[1], reaction[2] * swing[1] * up
    yaw = 0.5 * (swing[4] + swing[7])
    dx, dy = swing[5] - swing[2], swing[6] - swing[3]
    return (
        weight * (up * (swing[2] - swing[8]) + both * dx) - thrust * forward * dx - knee * cos(yaw),
        weight * (up * (swing[3] - swing[9]) + both * dy) - thrust * forward * dy - knee * sin(yaw),
    )


@compiled
def _under(foot: Row, zmp_offset: ZmpOffset) -> Point:
    """Return the ZMP of single support on a foot [m]."""
    forward = zmp_offset[0]
    inward = -zmp_offset[1] if foot[3] > 0.0 else zmp_offset[1]
    c, s = cos(foot[2]), sin(foot[2])
    return foot[0] + c * forward - s * inward, foot[1] + s * forward + c * inward


@compiled
def _swing(row: Array, begin: int, lift: float, origin: Row, landing: Row, zmp: Point) -> None:
    row[0], row[1] = begin, lift
    for k in range(3):
        row[2 + k], row[5 + k] = origin[k], landing[k]
    row[8], row[9] = zmp
