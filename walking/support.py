"""The region where the floor can push: the convex hull of one or two soles."""

from math import cos, hypot, inf, sin

from walking.robot_model import Sole
from walking.state import Footstep
from walking.value import value

Polygon = tuple[tuple[float, float], ...]
"""Corners of a convex polygon, counter-clockwise [m]."""

COLLINEAR = 1e-12  # twice the area under which three corners are taken for a line [m²]


@value
class SupportRegion:
    """Convex family of rectangles between two soles; with equal ends, one sole.

    The rectangle at share s has the corners (1 - s) A + s B of the two soles, so it lies in
    their hull whatever their directions.

    Attributes:
        ax, ay, ac, as_: centre [m] and direction (cosine, sine) of the first sole.
        bx, by, bc, bs: the same of the second sole.
        half_length, half_width: of either sole, margin taken off [m].
    """

    ax: float
    ay: float
    ac: float
    as_: float
    bx: float
    by: float
    bc: float
    bs: float
    half_length: float
    half_width: float

    def share(self, x: float, y: float) -> float:
        """Load share of the second sole under a ZMP at x, y [m], in [0, 1]."""
        dx, dy = self.bx - self.ax, self.by - self.ay
        square = dx * dx + dy * dy
        if square == 0.0:
            return 0.0
        return min(1.0, max(0.0, ((x - self.ax) * dx + (y - self.ay) * dy) / square))

    def clip(self, x: float, y: float) -> tuple[float, float]:
        """A point of the region near x, y: in the rectangle at its load share [m]."""
        s = self.share(x, y)
        r = 1.0 - s
        cx, cy = r * self.ax + s * self.bx, r * self.ay + s * self.by
        c, n = r * self.ac + s * self.bc, r * self.as_ + s * self.bs
        scale = c * c + n * n
        dx, dy = x - cx, y - cy
        u = (c * dx + n * dy) / scale
        v = (c * dy - n * dx) / scale
        length, width = self.half_length, self.half_width
        if -length <= u <= length and -width <= v <= width:
            return x, y
        u = min(length, max(-length, u))
        v = min(width, max(-width, v))
        return cx + c * u - n * v, cy + n * u + c * v


def support_region(sole: Sole, first: Footstep, second: Footstep, margin: float) -> SupportRegion:
    """Region of two feet on the floor, or of one when both arguments are the same foot."""
    ac, as_ = cos(first.yaw), sin(first.yaw)
    bc, bs = (ac, as_) if second is first else (cos(second.yaw), sin(second.yaw))
    return SupportRegion(
        ax=first.x + sole.centre * ac,
        ay=first.y + sole.centre * as_,
        ac=ac,
        as_=as_,
        bx=second.x + sole.centre * bc,
        by=second.y + sole.centre * bs,
        bc=bc,
        bs=bs,
        half_length=sole.half_length - margin,
        half_width=sole.half_width - margin,
    )


class Footing:
    """The soles that carry, what can be said of them computed only when they change.

    Args:
        sole: rectangle of either sole.
        feet: the unloading and the loading foot, the same foot twice in single support.

    Attributes:
        feet: these feet.
    """

    def __init__(self, sole: Sole, feet: tuple[Footstep, Footstep]) -> None:
        self._sole = sole
        self.feet = feet
        self._polygon: Polygon | None = None
        self._regions: dict[float, SupportRegion] = {}

    def stand(self, feet: tuple[Footstep, Footstep]) -> None:
        """Have the feet there."""
        if feet[0] is not self.feet[0] or feet[1] is not self.feet[1]:
            self.feet, self._polygon = feet, None
            self._regions.clear()

    def polygon(self) -> Polygon:
        """Hull of the soles."""
        if self._polygon is None:
            self._polygon = support_polygon(self._sole, *self.feet)
        return self._polygon

    def region(self, margin: float) -> SupportRegion:
        """Region that keeps a margin from the edges of the soles [m]."""
        found = self._regions.get(margin)
        if found is None:
            found = self._regions[margin] = support_region(self._sole, *self.feet, margin)
        return found


def support_polygon(sole: Sole, first: Footstep, second: Footstep) -> Polygon:
    """Convex hull of two soles on the floor, or one sole when both are the same foot."""
    corners = _corners(sole, second)
    return corners if second is first else _hull([*_corners(sole, first), *corners])


def depth(polygon: Polygon, x: float, y: float) -> float:
    """How far inside a convex polygon a point lies; negative outside [m]."""
    least = inf
    ax, ay = polygon[-1]
    for bx, by in polygon:
        dx, dy = bx - ax, by - ay
        least = min(least, (dx * (y - ay) - dy * (x - ax)) / hypot(dx, dy))
        ax, ay = bx, by
    return least


def _corners(sole: Sole, foot: Footstep) -> Polygon:
    c, s = cos(foot.yaw), sin(foot.yaw)
    front, back = sole.centre + sole.half_length, sole.centre - sole.half_length
    side = sole.half_width
    return tuple(
        (foot.x + c * u - s * v, foot.y + s * u + c * v)
        for u, v in ((front, -side), (front, side), (back, side), (back, -side))
    )


def _hull(points: list[tuple[float, float]]) -> Polygon:
    """Convex hull, counter-clockwise: Andrew's monotone chain."""
    points = sorted(set(points))
    halves = []
    for ordered in (points, points[::-1]):
        chain: list[tuple[float, float]] = []
        for x, y in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > COLLINEAR:
                    break
                chain.pop()
            chain.append((x, y))
        halves += chain[:-1]
    return tuple(halves)
