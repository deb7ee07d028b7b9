"""Knots of the ZMP as near to a reference as one equation for the DCM allows."""

from walking.support import SupportRegion

SOLVED = 1e-10  # DCM not accounted for that is rounding [m]
ITERATIONS = 20
HALVINGS = 6
SLACK = 1e-6  # weight of the DCM's miss where it has to be missed [1]

Box = tuple[float, float, float, float, float, float]
"""Nominal u, v, then low u, high u, low v, high v [m]."""

Gradient = tuple[float, float, float, float, float]
"""Σ w M u - DCM, x, y [m], and its derivative xx, xy, yy by λ [1]."""


class Cell:
    """Knots whose ZMP is in one rectangle: centre + M u with u in a box, M = [[c, -s], [s, c]].

    Args:
        centre: of the rectangle [m].
        direction: c, s; shorter than one between soles of different directions [1].
        box: nominal point and bounds in the rectangle's frame [m].
        knots: how many.

    Attributes:
        knots: how many.
        weights: of the knots in the DCM of now, all positive [1]; see `weigh`.
    """

    __slots__ = ("box", "centre", "direction", "knots", "largest", "squares", "total", "weights")

    def __init__(
        self,
        centre: tuple[float, float],
        direction: tuple[float, float],
        box: Box,
        knots: int = 1,
    ) -> None:
        self.centre, self.direction, self.box, self.knots = centre, direction, box, knots
        self.weights: list[float] = []
        self.total = self.squares = self.largest = 0.0

    def weigh(self, weights: list[float]) -> None:
        """Set the weights of the knots."""
        self.weights = weights
        self.total = sum(weights)
        self.squares = sum(w * w for w in weights)
        self.largest = max(weights)


class ZmpFit:
    """minimize Σ |u_j - û_j|² subject to Σ w_j (centre_j + M_j u_j) = DCM, u_j in its box.

    The dual has one unknown per axis, λ, with u_j = clip(û_j + w_j M_jᵀ λ); its gradient is
    piecewise linear and solved by Newton's method with step halving. That there is no
    solution shows early: the boxes do not reach as far as the DCM in the direction that is
    missing.

    Args:
        cells: rectangles with weighted knots.
        x, y: DCM that they bring about [m].

    Attributes:
        dual: λ of the solution; a good start for that of a similar program [1/m].
        evaluations: of the gradient so far.
    """

    def __init__(self, cells: list[Cell], x: float, y: float) -> None:
        self._cells = cells
        for cell in cells:
            x -= cell.total * cell.centre[0]
            y -= cell.total * cell.centre[1]
        self._x, self._y = x, y
        self.dual = (0.0, 0.0)
        self.evaluations = 0

    def solve(self, start: tuple[float, float]) -> bool:
        """Find λ, beginning at `start`.

        Returns:
            whether the program is feasible.
        """
        solved = self._newton(start, 0.0)
        if solved is None and start != (0.0, 0.0):
            # Where all knots are at their bounds Newton's method has nothing to go by.
            solved = self._newton((0.0, 0.0), 0.0)
        return solved is True

    def approach(self) -> tuple[float, float]:
        """Miss the DCM by as little as possible; the miss [m]."""
        self._newton((0.0, 0.0), SLACK)
        x, y, *_ = self._gradient(*self.dual, 0.0)
        return -x, -y

    def points(self) -> list[tuple[float, float]]:
        """The knots of the solution [m]."""
        lx, ly = self.dual
        points = []
        for cell in self._cells:
            (cx, cy), (c, s) = cell.centre, cell.direction
            p, q = c * lx + s * ly, c * ly - s * lx
            u0, v0, low_u, high_u, low_v, high_v = cell.box
            for w in cell.weights:
                u, v = u0 + w * p, v0 + w * q
                u = low_u if u < low_u else high_u if u > high_u else u
                v = low_v if v < low_v else high_v if v > high_v else v
                points.append((cx + c * u - s * v, cy + s * u + c * v))
        return points

    def _newton(self, start: tuple[float, float], slack: float) -> bool | None:
        """Solved, certainly infeasible, or given up (None)."""
        lx, ly = start
        x, y, xx, xy, yy = self._gradient(lx, ly, slack)
        outcome = None
        for _ in range(ITERATIONS):
            size = x * x + y * y
            if size < SOLVED * SOLVED:
                outcome = True
                break
            if slack == 0.0 and self._beyond(-x, -y):
                outcome = False
                break
            # Directions in which all knots are at their bounds stay where they are.
            small = 1e-9 * (xx + yy) + 1e-12
            xx, yy = xx + small, yy + small
            det = xx * yy - xy * xy
            sx, sy = (xy * y - yy * x) / det, (xy * x - xx * y) / det
            for _ in range(HALVINGS):
                new = self._gradient(lx + sx, ly + sy, slack)
                if new[0] * new[0] + new[1] * new[1] < size:
                    break
                sx, sy = 0.5 * sx, 0.5 * sy
            else:
                break
            lx, ly = lx + sx, ly + sy
            x, y, xx, xy, yy = new
        self.dual = (lx, ly)
        return outcome

    def _beyond(self, dx: float, dy: float) -> bool:
        """Whether the DCM is out of reach of the boxes in a direction."""
        reach = 0.0
        for cell in self._cells:
            c, s = cell.direction
            p, q = c * dx + s * dy, c * dy - s * dx
            _, _, low_u, high_u, low_v, high_v = cell.box
            reach += cell.total * (p * (high_u if p > 0.0 else low_u))
            reach += cell.total * (q * (high_v if q > 0.0 else low_v))
        return reach < dx * self._x + dy * self._y

    def _gradient(self, lx: float, ly: float, slack: float) -> Gradient:
        self.evaluations += 1
        gx, gy = slack * lx - self._x, slack * ly - self._y
        a, b, d = slack, 0.0, slack
        for cell in self._cells:
            c, s = cell.direction
            u0, v0, low_u, high_u, low_v, high_v = cell.box
            u, uu = _along(cell, u0, c * lx + s * ly, low_u, high_u)
            v, vv = _along(cell, v0, c * ly - s * lx, low_v, high_v)
            gx += c * u - s * v
            gy += s * u + c * v
            a += c * c * uu + s * s * vv
            b += c * s * (uu - vv)
            d += s * s * uu + c * c * vv
        return gx, gy, a, b, d


def _along(
    cell: Cell, nominal: float, slope: float, low: float, high: float
) -> tuple[float, float]:
    """Σ w clip(nominal + w slope) of a cell's knots, and its derivative by the slope."""
    if low <= nominal <= high and low <= nominal + cell.largest * slope <= high:
        return cell.total * nominal + cell.squares * slope, cell.squares
    moved = change = 0.0
    for w in cell.weights:
        u = nominal + w * slope
        if u < low:
            moved += w * low
        elif u > high:
            moved += w * high
        else:
            moved += w * u
            change += w * w
    return moved, change


def cell_at(region: SupportRegion, share: float, x: float, y: float) -> Cell:
    """The slice of a region at a share of the second sole, with its nominal point at x, y [m]."""
    rest = 1.0 - share
    cx, cy = rest * region.ax + share * region.bx, rest * region.ay + share * region.by
    c, s = rest * region.ac + share * region.bc, rest * region.as_ + share * region.bs
    u, v = _inside(c, s, x - cx, y - cy)
    length, width = region.half_length, region.half_width
    return Cell((cx, cy), (c, s), (u, v, -length, length, -width, width))


def limited(cell: Cell, x: float, y: float, reach: float) -> Cell:
    """One knot of a cell, within `reach` [m] of a point in it along both of its sides."""
    (cx, cy), (c, s) = cell.centre, cell.direction
    u0, v0, low_u, high_u, low_v, high_v = cell.box
    u, v = _inside(c, s, x - cx, y - cy)
    u, v = min(high_u, max(low_u, u)), min(high_v, max(low_v, v))
    low_u, high_u = max(low_u, u - reach), min(high_u, u + reach)
    low_v, high_v = max(low_v, v - reach), min(high_v, v + reach)
    return Cell(cell.centre, cell.direction, (u0, v0, low_u, high_u, low_v, high_v))


def _inside(c: float, s: float, dx: float, dy: float) -> tuple[float, float]:
    scale = c * c + s * s
    return (c * dx + s * dy) / scale, (c * dy - s * dx) / scale
