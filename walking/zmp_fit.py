"""Knots of the ZMP as near to a reference as one equation for the DCM allows."""

SOLVED = 1e-10  # DCM not accounted for that is rounding [m]
ITERATIONS = 20
HALVINGS = 6

Vector = tuple[float, float]

Box = tuple[float, float, float, float, float, float]
"""Nominal u, v, then low u, high u, low v, high v [m]."""

Gradient = tuple[float, float, float, float, float]
"""Σ w M u - DCM, x, y [m], and its derivative xx, xy, yy by λ [1]."""


class Cell:
    """Knots whose ZMP is in one parallelogram: centre + M u with u in a box.

    Args:
        centre: of the parallelogram [m].
        axes: columns of M: directions of its sides [1].
        box: nominal point and bounds along the sides [m].
        knots: how many.

    Attributes:
        knots: how many.
        weights: of the knots in the DCM of now, all positive [1]; see `weigh`.
    """

    __slots__ = ("axes", "box", "centre", "knots", "largest", "squares", "total", "weights")

    def __init__(
        self,
        centre: Vector,
        axes: tuple[Vector, Vector],
        box: Box,
        knots: int = 1,
    ) -> None:
        self.centre, self.axes, self.box, self.knots = centre, axes, box, knots
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
        solved = self._newton(start)
        if solved is None and start != (0.0, 0.0):
            # Where all knots are at their bounds Newton's method has nothing to go by.
            solved = self._newton((0.0, 0.0))
        return solved is True

    def points(self) -> list[tuple[float, float]]:
        """The knots of the solution [m]."""
        lx, ly = self.dual
        points = []
        for cell in self._cells:
            (cx, cy), ((ax, ay), (bx, by)) = cell.centre, cell.axes
            p, q = ax * lx + ay * ly, bx * lx + by * ly
            u0, v0, low_u, high_u, low_v, high_v = cell.box
            for w in cell.weights:
                u, v = u0 + w * p, v0 + w * q
                u = low_u if u < low_u else high_u if u > high_u else u
                v = low_v if v < low_v else high_v if v > high_v else v
                points.append((cx + ax * u + bx * v, cy + ay * u + by * v))
        return points

    def _newton(self, start: tuple[float, float]) -> bool | None:
        """Solved, certainly infeasible, or given up (None)."""
        lx, ly = start
        x, y, xx, xy, yy = self._gradient(lx, ly)
        outcome = None
        for _ in range(ITERATIONS):
            size = x * x + y * y
            if size < SOLVED * SOLVED:
                outcome = True
                break
            if self._beyond(-x, -y):
                outcome = False
                break
            # Directions in which all knots are at their bounds stay where they are.
            small = 1e-9 * (xx + yy) + 1e-12
            xx, yy = xx + small, yy + small
            det = xx * yy - xy * xy
            sx, sy = (xy * y - yy * x) / det, (xy * x - xx * y) / det
            for _ in range(HALVINGS):
                new = self._gradient(lx + sx, ly + sy)
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
            (ax, ay), (bx, by) = cell.axes
            p, q = ax * dx + ay * dy, bx * dx + by * dy
            _, _, low_u, high_u, low_v, high_v = cell.box
            reach += cell.total * (p * (high_u if p > 0.0 else low_u))
            reach += cell.total * (q * (high_v if q > 0.0 else low_v))
        return reach < dx * self._x + dy * self._y

    def _gradient(self, lx: float, ly: float) -> Gradient:
        self.evaluations += 1
        gx, gy = -self._x, -self._y
        xx = xy = yy = 0.0
        for cell in self._cells:
            (ax, ay), (bx, by) = cell.axes
            u0, v0, low_u, high_u, low_v, high_v = cell.box
            u, uu = _along(cell, u0, ax * lx + ay * ly, low_u, high_u)
            v, vv = _along(cell, v0, bx * lx + by * ly, low_v, high_v)
            gx += ax * u + bx * v
            gy += ay * u + by * v
            xx += ax * ax * uu + bx * bx * vv
            xy += ax * ay * uu + bx * by * vv
            yy += ay * ay * uu + by * by * vv
        return gx, gy, xx, xy, yy


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


def sides(axes: tuple[Vector, Vector], x: float, y: float) -> Vector:
    """Coordinates of a vector along two directions."""
    (ax, ay), (bx, by) = axes
    scale = ax * by - ay * bx
    return (x * by - y * bx) / scale, (y * ax - x * ay) / scale


def limited(cell: Cell, x: float, y: float, reach: float) -> Cell:
    """One knot of a cell, within `reach` [m] of a point in it along both of its sides."""
    cx, cy = cell.centre
    u0, v0, low_u, high_u, low_v, high_v = cell.box
    u, v = sides(cell.axes, x - cx, y - cy)
    u, v = min(high_u, max(low_u, u)), min(high_v, max(low_v, v))
    low_u, high_u = max(low_u, u - reach), min(high_u, u + reach)
    low_v, high_v = max(low_v, v - reach), min(high_v, v + reach)
    return Cell(cell.centre, cell.axes, (u0, v0, low_u, high_u, low_v, high_v))
