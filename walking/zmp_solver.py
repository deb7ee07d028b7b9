"""Quadratic program of ZMP planning, see `walking.zmp_plan`.

The dual has one unknown per axis, λ, with u_j = clip(û_j + w_j M_jᵀ λ); its gradient is piecewise
linear and solved by Newton's method with step halving. An infeasible program is detected early: the
boxes do not reach the DCM in the direction of the residual.
"""

from compilation import compiled
from compilation.record import record_type
from walking.plane import Array, Point
from walking.records import Record

KNOT = record_type(ticks=float, x=float, y=float)
"""Knot of the planned ZMP: ticks since the previous knot, position [m]."""

CELL = record_type(
    x=float,
    y=float,
    ax=float,
    ay=float,
    bx=float,
    by=float,
    nominal_u=float,
    nominal_v=float,
    low_u=float,
    high_u=float,
    low_v=float,
    high_v=float,
    weight=float,
    square=float,
    max_weight=float,
    begin=int,
    end=int,
)
"""Parallelogram of knots, see `walking.zmp_plan`: centre [m]; sides, columns of M [1]; nominal u
and v, and their bounds [m]; Σ w, Σ w² and max w of its knots [1]; first knot, and the one after the
last."""

SOLVED = 1e-10  # maximum residual of the DCM [m]
ITERATIONS = 20
HALVINGS = 6


@compiled
def solve(
    cells: Record, weights: Array, dcm: Point, guess: Point, knots: Record
) -> tuple[bool, Point, int]:
    """Solve for λ and set the knots.

    Args:
        cells: cells of the knots (n,).
        weights: weights of the knots (m,).
        dcm: right side of the equation [m].
        guess: initial guess of λ [1/m].
        knots: positions are set [m]; the last knot stays (m + 1,).

    Returns:
        whether the program is feasible, λ [1/m], and number of evaluations of the gradient.
    """
    x, y = dcm
    for cell in cells:
        x -= cell.weight * cell.x
        y -= cell.weight * cell.y
    outcome, lx, ly, evaluations = _newton(cells, weights, x, y, guess[0], guess[1])
    if outcome == 0 and (guess[0] != 0.0 or guess[1] != 0.0):
        # With all knots at their bounds the derivative is zero.
        outcome, lx, ly, more = _newton(cells, weights, x, y, 0.0, 0.0)
        evaluations += more
    _set_points(cells, weights, lx, ly, knots)
    return outcome == 1, (lx, ly), evaluations


@compiled
def _set_points(cells: Record, weights: Array, lx: float, ly: float, knots: Record) -> None:
    for cell in cells:
        p, q = cell.ax * lx + cell.ay * ly, cell.bx * lx + cell.by * ly
        for knot in range(cell.begin, cell.end):
            u = min(cell.high_u, max(cell.low_u, cell.nominal_u + weights[knot] * p))
            v = min(cell.high_v, max(cell.low_v, cell.nominal_v + weights[knot] * q))
            knots[knot].x = cell.x + cell.ax * u + cell.bx * v
            knots[knot].y = cell.y + cell.ay * u + cell.by * v


@compiled
def _newton(
    cells: Record, weights: Array, x: float, y: float, lx: float, ly: float
) -> tuple[int, float, float, int]:
    """Return 1 for solved, -1 for infeasible, 0 for not converged; λ; evaluations."""
    gx, gy, xx, xy, yy = _gradient(cells, weights, lx, ly)
    gx, gy = gx - x, gy - y
    outcome, evaluations = 0, 1
    for _ in range(ITERATIONS):
        size = gx * gx + gy * gy
        if size < SOLVED * SOLVED:
            outcome = 1
            break
        if _beyond(cells, x, y, -gx, -gy):
            outcome = -1
            break
        # Regularized in directions in which all knots are at their bounds.
        small = 1e-9 * (xx + yy) + 1e-12
        xx, yy = xx + small, yy + small
        det = xx * yy - xy * xy
        sx, sy = (xy * gy - yy * gx) / det, (xy * gx - xx * gy) / det
        nearer = False
        for _half in range(HALVINGS):
            gx, gy, xx, xy, yy = _gradient(cells, weights, lx + sx, ly + sy)
            gx, gy = gx - x, gy - y
            evaluations += 1
            if gx * gx + gy * gy < size:
                nearer = True
                break
            sx, sy = 0.5 * sx, 0.5 * sy
        if not nearer:
            break
        lx, ly = lx + sx, ly + sy
    return outcome, lx, ly, evaluations


@compiled
def _beyond(cells: Record, x: float, y: float, dx: float, dy: float) -> bool:
    """Whether the boxes do not reach the DCM in a direction."""
    reach = 0.0
    for cell in cells:
        p, q = cell.ax * dx + cell.ay * dy, cell.bx * dx + cell.by * dy
        reach += cell.weight * (p * (cell.high_u if p > 0.0 else cell.low_u))
        reach += cell.weight * (q * (cell.high_v if q > 0.0 else cell.low_v))
    return reach < dx * x + dy * y


@compiled
def _gradient(
    cells: Record, weights: Array, lx: float, ly: float
) -> tuple[float, float, float, float, float]:
    """Return Σ w M u, x, y [m], and its derivative xx, xy, yy by λ."""
    gx = gy = xx = xy = yy = 0.0
    for cell in cells:
        own = weights[cell.begin : cell.end]
        ax, ay, bx, by = cell.ax, cell.ay, cell.bx, cell.by
        slope_u, slope_v = ax * lx + ay * ly, bx * lx + by * ly
        u, uu = _along(cell, own, cell.nominal_u, slope_u, cell.low_u, cell.high_u)
        v, vv = _along(cell, own, cell.nominal_v, slope_v, cell.low_v, cell.high_v)
        gx += ax * u + bx * v
        gy += ay * u + by * v
        xx += ax * ax * uu + bx * bx * vv
        xy += ax * ay * uu + bx * by * vv
        yy += ay * ay * uu + by * by * vv
    return gx, gy, xx, xy, yy


@compiled
def _along(
    cell: Record, weights: Array, nominal: float, slope: float, low: float, high: float
) -> Point:
    """Return Σ w clip(nominal + w slope) over the knots of a cell, and its derivative."""
    if low <= nominal <= high and low <= nominal + cell.max_weight * slope <= high:
        return cell.weight * nominal + cell.square * slope, cell.square
    total = change = 0.0
    for w in weights:
        u = nominal + w * slope
        if u < low:
            total += w * low
        elif u > high:
            total += w * high
        else:
            total += w * u
            change += w * w
    return total, change
