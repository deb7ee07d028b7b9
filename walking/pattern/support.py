"""Support region and support polygon of one or two soles."""

from math import cos, sin

import numpy as np

from walking.arrays import Array
from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.pattern import support_kernel
from walking.planar import from_frame, norm

Polygon = tuple[tuple[float, float], ...]
"""Corners of a convex polygon, counter-clockwise [m]."""

SAME = 1e-9  # distance of equal corners [m]


class SupportRegion:
    """Admissible ZMP: convex family of rectangles between two soles, or one sole.

    The rectangle at load fraction s has the corners (1 - s) A + s B of the two soles, so it is
    within their hull.

    Args:
        row: see `walking.pattern.support_kernel` (10,).
    """

    __slots__ = ("row",)

    def __init__(self, row: Array) -> None:
        self.row = row

    def load_fraction(self, x: float, y: float) -> float:
        """Return the load fraction of the second sole for a ZMP at x, y [m], in [0, 1]."""
        return support_kernel.load_fraction(self.row, x, y)

    def clip(self, x: float, y: float) -> tuple[float, float]:
        """Clip a point to the region: to the rectangle at its load fraction [m]."""
        return support_kernel.clip(self.row, x, y)


def support_region(sole: Sole, first: Foothold, second: Foothold, margin: float) -> SupportRegion:
    """Return the region of two feet, or of one foot passed twice."""
    ac, as_ = cos(first.yaw), sin(first.yaw)
    bc, bs = (ac, as_) if second is first else (cos(second.yaw), sin(second.yaw))
    centre = sole.centre
    return SupportRegion(
        np.array(
            [
                *(first.x + centre * ac, first.y + centre * as_, ac, as_),
                *(second.x + centre * bc, second.y + centre * bs, bc, bs),
                *(sole.half_length - margin, sole.half_width - margin),
            ]
        )
    )


class SupportPolygon:
    """Support polygon of the feet in contact, cached until they change.

    Args:
        sole: rectangle of each sole.
        feet: unloading and loading foot, in single support twice the support foot.

    Attributes:
        feet: these feet.
    """

    def __init__(self, sole: Sole, feet: tuple[Foothold, Foothold]) -> None:
        self._sole = sole
        self.feet = feet
        self._edges: Array | None = None
        self._regions: dict[float, SupportRegion] = {}

    def update(self, feet: tuple[Foothold, Foothold]) -> None:
        """Replace the feet in contact."""
        if feet[0] is not self.feet[0] or feet[1] is not self.feet[1]:
            self.feet, self._edges = feet, None
            self._regions.clear()

    def edges(self) -> Array:
        """Return the edges of the polygon, see `walking.pattern.support_kernel` (n, 5) [m]."""
        if self._edges is None:
            self._edges = edges(support_polygon(self._sole, *self.feet))
        return self._edges

    def depth(self, x: float, y: float) -> float:
        """Return the distance of a point from the edge of the polygon, negative outside [m]."""
        return support_kernel.depth(self.edges(), x, y)

    def region(self, margin: float) -> SupportRegion:
        """Return the region with a margin from the edges of the soles [m]."""
        if margin not in self._regions:
            self._regions[margin] = support_region(self._sole, *self.feet, margin)
        return self._regions[margin]


def support_polygon(sole: Sole, first: Foothold, second: Foothold) -> Polygon:
    """Return the convex hull of two soles, or of one foot passed twice."""
    corners = _corners(sole, second)
    return corners if second is first else _hull([*_corners(sole, first), *corners])


def edges(polygon: Polygon) -> Array:
    """Return the edges of a polygon, see `walking.pattern.support_kernel` (n, 5) [m]."""
    rows = []
    ax, ay = polygon[-1]
    for bx, by in polygon:
        dx, dy = bx - ax, by - ay
        rows.append((ax, ay, dx, dy, norm(dx, dy)))
        ax, ay = bx, by
    return np.array(rows)


def _corners(sole: Sole, foot: Foothold) -> Polygon:
    front, back = sole.centre + sole.half_length, sole.centre - sole.half_length
    side = sole.half_width
    return tuple(
        from_frame(foot.frame, u, v)
        for u, v in ((front, -side), (front, side), (back, side), (back, -side))
    )


def _hull(points: list[tuple[float, float]]) -> Polygon:
    """Return the convex hull, counter-clockwise: Andrew's monotone chain.

    Equal points count once. The test of the turn has no tolerance, which could drop a corner of an
    edge along y.
    """
    points = sorted(
        (x, y)
        for i, (x, y) in enumerate(points)
        if all(norm(x - u, y - v) > SAME for u, v in points[:i])
    )
    halves = []
    for ordered in (points, points[::-1]):
        chain: list[tuple[float, float]] = []
        for x, y in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                    break
                chain.pop()
            chain.append((x, y))
        halves += chain[:-1]
    return tuple(halves)
