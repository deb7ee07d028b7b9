"""The footholds to come and the ZMP reference that follows from them, compiled.

A foothold is x, y [m], yaw [rad], and 1 if it is a left one, 0 if not.
"""

from math import cos, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Row = tuple[float, float, float, float]
"""A foothold, see `Foothold.row`."""

Placement = tuple[float, float, float]
Placements = tuple[Placement, Placement]
"""Landing in the frame of the support foot, x, y [m] and direction [rad]: the right foot's and the
left foot's."""

Spot = tuple[float, float]
"""Where the ZMP is meant to be under a foot: forward and inward of its origin [m]."""

Chain = tuple[Placements, Placements, tuple[float, float], int]
"""Strides; those of stepping in place; distance along x and y [m] and angle [rad] at which a
foothold is one of standing; most footholds to come."""

RAMP = 13  # numbers of a ramp, see `Ramps`


@njit(cache=True)
def onwards(
    unloading: Row,
    support: Row,
    landing: Row,
    chain: Chain,
    moving: bool,
    zmp: tuple[float, float],
    ticks: tuple[int, int, int, int, int],
    spot: Spot,
) -> tuple[Array, Array]:
    """Footholds of a walk (n, 4), see `sequence`, and its ZMP (m, 13), see `ramps`."""
    steps, ends = sequence(support, landing, chain, moving)
    return steps, ramps(unloading, support, steps, zmp, ticks, spot, ends)


@njit(cache=True)
def sequence(support: Row, landing: Row, chain: Chain, moving: bool) -> tuple[Array, bool]:
    """Footholds from `landing` on, and whether the walk ends after the last.

    Args:
        support: the foot on the floor.
        landing: where the other foot is about to land.
        chain: how they follow each other.
        moving: whether more than closing the stance is wanted.

    Returns:
        the footholds (n, 4), and whether the walk ends after the last.
    """
    wish, still, near, most = chain
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
        before, last = last, _landing(last, wish)
    return steps, False


@njit(cache=True)
def ramps(
    unloading: Row,
    support: Row,
    steps: Array,
    zmp: tuple[float, float],
    ticks: tuple[int, int, int, int, int],
    spot: Spot,
    ends: bool,
) -> Array:
    """ZMP reference of a walk.

    Args:
        unloading: where the foot stands that is about to swing.
        support: the foot that carries in this footstep.
        steps: footholds to come (n, 4).
        zmp: of now, while the weight goes over to the support foot [m].
        ticks: left of that double support, zero in single support; left of the single support
            after it; of a double and a single support to come; of the last double support.
        spot: of the ZMP under a foot.
        ends: whether the walk ends with both feet carrying alike after the last foothold.

    Returns:
        the reference, see `Ramps` (m, 13).
    """
    shift, carry, double, single, stop = ticks
    table = np.empty((2 * steps.shape[0] + 2, RAMP))
    px, py = _under(support, spot)
    row = 0
    if shift > 0:
        _ramp(table[row], shift, zmp[0], zmp[1], px, py, unloading, support)
        row += 1
    _ramp(table[row], carry, px, py, px, py, support, support)
    row += 1
    before = support
    for k in range(steps.shape[0]):
        step = (steps[k, 0], steps[k, 1], steps[k, 2], steps[k, 3])
        x, y = _under(step, spot)
        if ends and k == steps.shape[0] - 1:
            bx, by = _under(before, spot)
            _ramp(table[row], stop, px, py, 0.5 * (bx + x), 0.5 * (by + y), before, step)
            row += 1
        else:
            _ramp(table[row], double, px, py, x, y, before, step)
            _ramp(table[row + 1], single, x, y, x, y, step, step)
            row += 2
        before, px, py = step, x, y
    return table[:row]


@njit(cache=True)
def _landing(support: Row, strides: Placements) -> Row:
    """Next foothold of the foot that is not `support`."""
    x, y, turned = strides[0] if support[3] > 0.0 else strides[1]
    c, s = cos(support[2]), sin(support[2])
    return (
        support[0] + c * x - s * y,
        support[1] + s * x + c * y,
        support[2] + turned,
        1.0 - support[3],
    )


@njit(cache=True)
def _under(foot: Row, spot: Spot) -> tuple[float, float]:
    """ZMP under a foot that carries alone [m]."""
    forward = spot[0]
    inward = -spot[1] if foot[3] > 0.0 else spot[1]
    c, s = cos(foot[2]), sin(foot[2])
    return foot[0] + c * forward - s * inward, foot[1] + s * forward + c * inward


@njit(cache=True)
def _ramp(
    row: Array,
    ticks: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    one: Row,
    two: Row,
) -> None:
    row[0], row[1], row[2], row[3], row[4] = ticks, ax, ay, bx, by
    row[5], row[6], row[7], row[8] = one
    row[9], row[10], row[11], row[12] = two
