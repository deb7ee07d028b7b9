"""The region where the floor can push: the convex hull of one or two soles."""

from dataclasses import dataclass
from math import cos, sin

from walking.robot_model import Sole
from walking.state import Footstep


@dataclass(frozen=True, slots=True)
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
