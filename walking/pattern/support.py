"""The region where the floor can push: the convex hull of one or two soles."""

from math import cos, dist, hypot, sin

import numpy as np
from numpy.typing import NDArray

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.pattern import support_kernel

Array = NDArray[np.float64]
Polygon = tuple[tuple[float, float], ...]
"""Corners of a convex polygon, counter-clockwise [m]."""

SAME = 1e-9  # distance within which two corners are one [m]


class SupportRegion:
    """Convex family of rectangles between two soles; with equal ends, one sole.

    The rectangle at share s has the corners (1 - s) A + s B of the two soles, so it lies in
    their hull whatever their directions.

    Args:
        row: centres, directions and half sides, see `walking.pattern.support_kernel` (10,).
    """

    __slots__ = ("row",)

    def __init__(self, row: Array) -> None:
        self.row = row

    def share(self, x: float, y: float) -> float:
        """Load share of the second sole under a ZMP at x, y [m], in [0, 1]."""
        return support_kernel.share(self.row, x, y)

    def clip(self, x: float, y: float) -> tuple[float, float]:
        """A point of the region near x, y: in the rectangle at its load share [m]."""
        return support_kernel.clip(self.row, x, y)


def support_region(sole: Sole, first: Foothold, second: Foothold, margin: float) -> SupportRegion:
    """Region of two feet on the floor, or of one when both arguments are the same foot."""
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


class Footing:
    """The soles that carry, what can be said of them computed only when they change.

    Args:
        sole: rectangle of either sole.
        feet: the unloading and the loading foot, the same foot twice in single support.

    Attributes:
        feet: these feet.
    """

    def __init__(self, sole: Sole, feet: tuple[Foothold, Foothold]) -> None:
        self._sole = sole
        self.feet = feet
        self._polygon: Polygon | None = None
        self._edges: Array | None = None
        self._regions: dict[float, SupportRegion] = {}

    def stand(self, feet: tuple[Foothold, Foothold]) -> None:
        """Have the feet there."""
        if feet[0] is not self.feet[0] or feet[1] is not self.feet[1]:
            self.feet, self._polygon, self._edges = feet, None, None
            self._regions.clear()

    def polygon(self) -> Polygon:
        """Hull of the soles."""
        if self._polygon is None:
            self._polygon = support_polygon(self._sole, *self.feet)
        return self._polygon

    def edges(self) -> Array:
        """Its edges, see `walking.pattern.support_kernel` (n, 5) [m]."""
        if self._edges is None:
            self._edges = edges(self.polygon())
        return self._edges

    def depth(self, x: float, y: float) -> float:
        """How far inside that hull a point lies; negative outside [m]."""
        return support_kernel.depth(self.edges(), x, y)

    def region(self, margin: float) -> SupportRegion:
        """Region that keeps a margin from the edges of the soles [m]."""
        found = self._regions.get(margin)
        if found is None:
            found = self._regions[margin] = support_region(self._sole, *self.feet, margin)
        return found


def support_polygon(sole: Sole, first: Foothold, second: Foothold) -> Polygon:
    """Convex hull of two soles on the floor, or one sole when both are the same foot."""
    corners = _corners(sole, second)
    return corners if second is first else _hull([*_corners(sole, first), *corners])


def edges(polygon: Polygon) -> Array:
    """Edges of a polygon, see `walking.pattern.support_kernel` (n, 5) [m]."""
    rows = []
    ax, ay = polygon[-1]
    for bx, by in polygon:
        dx, dy = bx - ax, by - ay
        rows.append((ax, ay, dx, dy, hypot(dx, dy)))
        ax, ay = bx, by
    return np.array(rows)


def _corners(sole: Sole, foot: Foothold) -> Polygon:
    c, s = cos(foot.yaw), sin(foot.yaw)
    front, back = sole.centre + sole.half_length, sole.centre - sole.half_length
    side = sole.half_width
    return tuple(
        (foot.x + c * u - s * v, foot.y + s * u + c * v)
        for u, v in ((front, -side), (front, side), (back, side), (back, -side))
    )


def _hull(points: list[tuple[float, float]]) -> Polygon:
    """Convex hull, counter-clockwise: Andrew's monotone chain.

    Points that coincide have no direction between them and count once. Beyond that the sign alone
    decides: on an edge along y, a tolerance could take the corner for a point between others.
    """
    points = sorted(p for i, p in enumerate(points) if all(dist(p, q) > SAME for q in points[:i]))
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
