"""Support region and support polygon of one or two soles.

The region is a convex family of rectangles between two soles, or one sole. The rectangle at load
fraction s has the corners (1 - s) A + s B of the two soles, so it is within their hull.
"""

from math import cos, inf, sin
from typing import NamedTuple

import numpy as np

from compilation import compiled
from walking.model import Sole
from walking.plan.footsteps import Foothold
from walking.plane import Array, Point, clamp, from_frame, norm, within

SAME = 1e-9  # distance of equal corners [m]
CORNERS = 8  # of two soles


class Region(NamedTuple):
    """Admissible ZMP.

    Attributes:
        ax, ay: centre of the first sole [m].
        ac, as_: direction of the first sole, cosine and sine [1].
        bx, by: centre of the second sole [m].
        bc, bs: direction of the second sole, cosine and sine [1].
        length, width: half of length and width of a sole, minus a margin [m].
    """

    ax: float
    ay: float
    ac: float
    as_: float
    bx: float
    by: float
    bc: float
    bs: float
    length: float
    width: float


@compiled
def support_region(sole: Sole, one: Foothold, other: Foothold, margin: float) -> Region:
    """Return the region of two feet, or of one foot passed twice, with a margin [m]."""
    ac, as_, bc, bs = cos(one.yaw), sin(one.yaw), cos(other.yaw), sin(other.yaw)
    centre = sole.centre
    return Region(
        one.x + centre * ac,
        one.y + centre * as_,
        ac,
        as_,
        other.x + centre * bc,
        other.y + centre * bs,
        bc,
        bs,
        sole.half_length - margin,
        sole.half_width - margin,
    )


@compiled
def load_fraction(region: Region, x: float, y: float) -> float:
    """Return the load fraction of the second sole for a ZMP at x, y [m], in [0, 1]."""
    dx, dy = region.bx - region.ax, region.by - region.ay
    square = dx * dx + dy * dy
    if square == 0.0:
        return 0.0
    along = (x - region.ax) * dx + (y - region.ay) * dy
    return within(along / square, 0.0, 1.0)


@compiled
def clip(region: Region, x: float, y: float) -> Point:
    """Clip a point to the region: to the rectangle at its load fraction [m]."""
    s = load_fraction(region, x, y)
    r = 1.0 - s
    cx, cy = r * region.ax + s * region.bx, r * region.ay + s * region.by
    c, n = r * region.ac + s * region.bc, r * region.as_ + s * region.bs
    scale = c * c + n * n
    dx, dy = x - cx, y - cy
    u = (c * dx + n * dy) / scale
    v = (c * dy - n * dx) / scale
    if -region.length <= u <= region.length and -region.width <= v <= region.width:
        return x, y
    u = clamp(u, region.length)
    v = clamp(v, region.width)
    return cx + c * u - n * v, cy + n * u + c * v


@compiled
def polygon(sole: Sole, one: Foothold, other: Foothold, single: bool) -> Array:
    """Return the corners of the support polygon, counter-clockwise (n, 2) [m].

    Args:
        sole: rectangle of each sole.
        one: unloading foot.
        other: loading foot.
        single: whether the loading foot alone supports.
    """
    corners = np.empty((CORNERS, 2))
    if single:
        _set_corners(corners[:4], sole, other)
        return corners[:4]
    _set_corners(corners[:4], sole, one)
    _set_corners(corners[4:], sole, other)
    return hull(corners)


@compiled
def _set_corners(corners: Array, sole: Sole, foot: Foothold) -> None:
    front, back = sole.centre + sole.half_length, sole.centre - sole.half_length
    side, frame = sole.half_width, (foot.x, foot.y, foot.yaw)
    corners[0, 0], corners[0, 1] = from_frame(frame, front, -side)
    corners[1, 0], corners[1, 1] = from_frame(frame, front, side)
    corners[2, 0], corners[2, 1] = from_frame(frame, back, side)
    corners[3, 0], corners[3, 1] = from_frame(frame, back, -side)


@compiled
def hull(points: Array) -> Array:
    """Return the convex hull, counter-clockwise: Andrew's monotone chain.

    Equal points count once. The test of the turn has no tolerance, which could drop a corner of an
    edge along y.

    Args:
        points: positions (n, 2) [m].
    """
    number = 0
    ordered = np.empty_like(points)
    for k in range(points.shape[0]):
        x, y = points[k, 0], points[k, 1]
        new = True
        for other in range(k):
            new = new and norm(x - points[other, 0], y - points[other, 1]) > SAME
        if new:
            slot = number
            while slot > 0 and (
                ordered[slot - 1, 0] > x or (ordered[slot - 1, 0] == x and ordered[slot - 1, 1] > y)
            ):
                ordered[slot, 0], ordered[slot, 1] = ordered[slot - 1, 0], ordered[slot - 1, 1]
                slot -= 1
            ordered[slot, 0], ordered[slot, 1] = x, y
            number += 1
    chain = np.empty((2 * number, 2))
    count = 0
    for half in range(2):
        begin = count
        for k in range(number):
            index = k if half == 0 else number - 1 - k
            x, y = ordered[index, 0], ordered[index, 1]
            while count > begin + 1:
                ax, ay = chain[count - 2, 0], chain[count - 2, 1]
                bx, by = chain[count - 1, 0], chain[count - 1, 1]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                    break
                count -= 1
            chain[count, 0], chain[count, 1] = x, y
            count += 1
        count -= 1  # the first point of the other half
    return chain[:count]


@compiled
def depth(corners: Array, x: float, y: float) -> float:
    """Return the distance of a point from the edge of a polygon, negative outside [m]."""
    distance = inf
    number = corners.shape[0]
    for k in range(number):
        before = corners[k - 1 if k > 0 else number - 1]
        ax, ay = before[0], before[1]
        dx, dy = corners[k, 0] - ax, corners[k, 1] - ay
        distance = min(distance, (dx * (y - ay) - dy * (x - ax)) / norm(dx, dy))
    return distance
