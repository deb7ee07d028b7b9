"""Planned footholds and their ZMP reference, compiled.

A foothold is a row x, y [m], yaw [rad], 1 for the left or 0 for the right foot.
"""

from math import cos, sin

import numpy as np

from compilation import compiled
from walking.arrays import Array, Point
from walking.footsteps.stride import Placement

Row = tuple[float, float, float, float]
"""Foothold, see `Foothold.row`."""

Placements = tuple[Placement, Placement]
"""Landings of the right and left foot in the frame of the support foot, x, y [m], yaw [rad]."""

ZmpOffset = tuple[float, float]
"""ZMP of single support in the foot frame, forward and inward [m]."""

Chain = tuple[Placements, Placements, tuple[float, float], int]
"""Strides; strides of stepping in place; tolerances of a parallel stance in x and y [m] and yaw
[rad]; maximum number of footholds."""

RAMP = 13  # columns of a ramp, see `Ramps`


@compiled
def plan_walk(
    unloading: Row,
    support: Row,
    landing: Row,
    chain: Chain,
    moving: bool,
    zmp: Point,
    ticks: tuple[int, int, int, int, int],
    zmp_offset: ZmpOffset,
) -> tuple[Array, Array]:
    """Return the footholds of a walk (n, 4), see `sequence`, and its ZMP (m, 13), see `ramps`."""
    steps, ends = sequence(support, landing, chain, moving)
    return steps, ramps(unloading, support, steps, zmp, ticks, zmp_offset, ends)


@compiled
def sequence(support: Row, landing: Row, chain: Chain, moving: bool) -> tuple[Array, bool]:
    """Return the footholds from `landing` on, and whether the walk ends after the last.

    Args:
        support: support foot.
        landing: of the swing foot.
        chain: rule of the following footholds.
        moving: whether the walk goes on; if not, it ends as soon as the stance is parallel.

    Returns:
        the footholds (n, 4), and whether the walk ends after the last.
    """
    wanted, still, near, most = chain
    steps = np.empty((most, 4))
    before, last = support, landing
    for k in range(most):
        steps[k, 0], steps[k, 1], steps[k, 2], steps[k, 3] = last
        if k + 1 < most and not moving:
            rest = _landing(before, still)
            if (
                abs(last[0] - rest[0]) < near[0]
                and abs(last[1] - rest[1]) < near[0]
                and abs(last[2] - rest[2]) < near[1]
            ):
                return steps[: k + 1], True
        before, last = last, _landing(last, wanted)
    return steps, False


@compiled
def ramps(
    unloading: Row,
    support: Row,
    steps: Array,
    zmp: Point,
    ticks: tuple[int, int, int, int, int],
    zmp_offset: ZmpOffset,
    ends: bool,
) -> Array:
    """Return the ZMP reference of a walk.

    Args:
        unloading: foot that swings next.
        support: support foot of this footstep.
        steps: planned footholds (n, 4).
        zmp: present ZMP, in double support [m].
        ticks: remaining ticks of the present double support, zero in single support; of the
            single support after it; ticks of later double and single supports; of the last
            double support.
        zmp_offset: see `ZmpOffset`.
        ends: whether the walk ends with equal loads after the last foothold.

    Returns:
        the reference, see `Ramps` (m, 13).
    """
    shift, carry, double, single, stop = ticks
    table = np.empty((2 * steps.shape[0] + 2, RAMP))
    px, py = _under(support, zmp_offset)
    row = 0
    if shift > 0:
        _ramp(table[row], shift, zmp[0], zmp[1], px, py, unloading, support)
        row += 1
    _ramp(table[row], carry, px, py, px, py, support, support)
    row += 1
    before = support
    for k in range(steps.shape[0]):
        step = (steps[k, 0], steps[k, 1], steps[k, 2], steps[k, 3])
        x, y = _under(step, zmp_offset)
        if ends and k == steps.shape[0] - 1:
            bx, by = _under(before, zmp_offset)
            _ramp(table[row], stop, px, py, 0.5 * (bx + x), 0.5 * (by + y), before, step)
            row += 1
        else:
            _ramp(table[row], double, px, py, x, y, before, step)
            _ramp(table[row + 1], single, x, y, x, y, step, step)
            row += 2
        before, px, py = step, x, y
    return table[:row]


@compiled
def _landing(support: Row, strides: Placements) -> Row:
    """Return the next foothold of the swing foot."""
    x, y, turned = strides[0] if support[3] > 0.0 else strides[1]
    c, s = cos(support[2]), sin(support[2])
    return (
        support[0] + c * x - s * y,
        support[1] + s * x + c * y,
        support[2] + turned,
        1.0 - support[3],
    )


@compiled
def _under(foot: Row, zmp_offset: ZmpOffset) -> Point:
    """Return the ZMP of single support on a foot [m]."""
    forward = zmp_offset[0]
    inward = -zmp_offset[1] if foot[3] > 0.0 else zmp_offset[1]
    c, s = cos(foot[2]), sin(foot[2])
    return foot[0] + c * forward - s * inward, foot[1] + s * forward + c * inward


@compiled
def _ramp(
    row: Array, ticks: int, ax: float, ay: float, bx: float, by: float, one: Row, two: Row
) -> None:
    row[0], row[1], row[2], row[3], row[4] = ticks, ax, ay, bx, by
    row[5], row[6], row[7], row[8] = one
    row[9], row[10], row[11], row[12] = two
