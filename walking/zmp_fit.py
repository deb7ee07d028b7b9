"""Knots of the ZMP as near to a reference as one equation for the DCM allows."""

from dataclasses import dataclass

from walking.support import SupportRegion

SOLVED = 1e-10  # DCM not accounted for that is rounding [m]
ITERATIONS = 20
HALVINGS = 6


@dataclass(slots=True)
class Knot:
    """Where the ZMP may be at one time: centre + M u with u in a box, M = [[c, -s], [s, c]].

    Attributes:
        ticks: since the knot before.
        cx, cy: centre of the rectangle [m].
        c, s: its direction, scaled between soles of different directions [1].
        u, v: nominal point in the box, later the planned one [m].
        low_u, high_u, low_v, high_v: the box [m].
        weight: of the knot in the DCM of now [1].
    """

    ticks: int
    cx: float
    cy: float
    c: float
    s: float
    u: float
    v: float
    low_u: float
    high_u: float
    low_v: float
    high_v: float
    weight: float = 0.0


class ZmpFit:
    """minimize Σ |u_j - û_j|² subject to Σ w_j (centre_j + M_j u_j) = DCM, u_j in its box.

    The dual has one unknown per axis, λ, with u_j = clip(û_j + w_j M_jᵀ λ); its gradient is
    piecewise linear and solved by Newton's method with step halving.

    Args:
        knots: weights and boxes; `solve` sets their points.
        x, y: DCM that they bring about [m].
    """

    def __init__(self, knots: list[Knot], x: float, y: float) -> None:
        self._knots = knots
        for knot in knots:
            x -= knot.weight * knot.cx
            y -= knot.weight * knot.cy
        self._x, self._y = x, y
        self._points: list[tuple[float, float]] = []

    def solve(self) -> tuple[float, float]:
        """Set the points of the knots.

        Returns:
            DCM x, y that they fall short of [m]: exactly zero if the program is feasible.
        """
        lx = ly = 0.0
        gx, gy, hessian = self._gradient(lx, ly)
        for _ in range(ITERATIONS):
            size = gx * gx + gy * gy
            if size < SOLVED * SOLVED:
                break
            a, b, d = hessian
            # Directions in which all knots are at their bounds stay where they are.
            small = 1e-9 * (a + d) + 1e-12
            a, d = a + small, d + small
            det = a * d - b * b
            sx, sy = (b * gy - d * gx) / det, (b * gx - a * gy) / det
            for _ in range(HALVINGS):
                nx, ny, hessian = self._gradient(lx + sx, ly + sy)
                if nx * nx + ny * ny < size:
                    break
                sx, sy = 0.5 * sx, 0.5 * sy
            else:
                break
            lx, ly, gx, gy = lx + sx, ly + sy, nx, ny
        gx, gy, _ = self._gradient(lx, ly)
        for knot, (u, v) in zip(self._knots, self._points, strict=True):
            knot.u, knot.v = u, v
        return (0.0, 0.0) if gx * gx + gy * gy < SOLVED * SOLVED else (-gx, -gy)

    def _gradient(self, lx: float, ly: float) -> tuple[float, float, tuple[float, float, float]]:
        """Σ w M u - DCM, and its derivative (xx, xy, yy) by λ."""
        gx, gy = -self._x, -self._y
        a = b = d = 0.0
        points = []
        for knot in self._knots:
            w, c, s = knot.weight, knot.c, knot.s
            u = knot.u + w * (c * lx + s * ly)
            v = knot.v + w * (c * ly - s * lx)
            square = w * w
            if u < knot.low_u:
                u = knot.low_u
            elif u > knot.high_u:
                u = knot.high_u
            else:
                a, b, d = a + square * c * c, b + square * c * s, d + square * s * s
            if v < knot.low_v:
                v = knot.low_v
            elif v > knot.high_v:
                v = knot.high_v
            else:
                a, b, d = a + square * s * s, b - square * c * s, d + square * c * c
            gx += w * (c * u - s * v)
            gy += w * (s * u + c * v)
            points.append((u, v))
        self._points = points
        return gx, gy, (a, b, d)


def knot_at(ticks: int, region: SupportRegion, x: float, y: float, *, on_second: bool) -> Knot:
    """A knot with its nominal point at x, y, on the second sole alone if it must be."""
    share = 1.0 if on_second else region.share(x, y)
    rest = 1.0 - share
    cx, cy = rest * region.ax + share * region.bx, rest * region.ay + share * region.by
    c, s = rest * region.ac + share * region.bc, rest * region.as_ + share * region.bs
    scale, dx, dy = c * c + s * s, x - cx, y - cy
    length, width = region.half_length, region.half_width
    u, v = (c * dx + s * dy) / scale, (c * dy - s * dx) / scale
    return Knot(ticks, cx, cy, c, s, u, v, -length, length, -width, width)


def limit_rate(knot: Knot, x: float, y: float, reach: float) -> None:
    """Keep a knot within `reach` [m] of a point in its rectangle, along both sides."""
    scale, dx, dy = knot.c * knot.c + knot.s * knot.s, x - knot.cx, y - knot.cy
    u, v = (knot.c * dx + knot.s * dy) / scale, (knot.c * dy - knot.s * dx) / scale
    u = min(knot.high_u, max(knot.low_u, u))
    v = min(knot.high_v, max(knot.low_v, v))
    knot.low_u, knot.high_u = max(knot.low_u, u - reach), min(knot.high_u, u + reach)
    knot.low_v, knot.high_v = max(knot.low_v, v - reach), min(knot.high_v, v + reach)
