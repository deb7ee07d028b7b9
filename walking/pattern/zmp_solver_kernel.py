"""Quadratic program of ZMP planning, compiled; see `walking.pattern.zmp_layout_kernel`.

The dual has one unknown per axis, λ, with u_j = clip(û_j + w_j M_jᵀ λ); its gradient is piecewise
linear and solved by Newton's method with step halving. An infeasible program is detected early: the
boxes do not reach the DCM in the direction of the residual.
"""

from compilation import compiled
from walking.arrays import Array, Indices, Point

SOLVED = 1e-10  # maximum residual of the DCM [m]
ITERATIONS = 20
HALVINGS = 6


@compiled
def solve(
    cells: Array, starts: Indices, weights: Array, dcm: Point, start: Point, knots: Array
) -> tuple[bool, Point, int]:
    """Solve for λ and set the knots.

    Args:
        cells: of the knots.
        starts: of the knots in the cells.
        weights: of the knots.
        dcm: of the constraint [m].
        start: initial guess of λ [1/m].
        knots: x, y are set, the last two columns [m]; the last knot stays (n, 3).

    Returns:
        whether the program is feasible, λ [1/m], and number of evaluations of the gradient.
    """
    x, y = dcm
    for k in range(starts.size - 1):
        x -= cells[k, 12] * cells[k, 0]
        y -= cells[k, 12] * cells[k, 1]
    outcome, lx, ly, evaluations = _newton(cells, starts, weights, x, y, start[0], start[1])
    if outcome == 0 and (start[0] != 0.0 or start[1] != 0.0):
        # With all knots at their bounds the derivative is zero.
        outcome, lx, ly, more = _newton(cells, starts, weights, x, y, 0.0, 0.0)
        evaluations += more
    _set_points(cells, starts, weights, (lx, ly), knots)
    return outcome == 1, (lx, ly), evaluations


@compiled
def _set_points(cells: Array, starts: Indices, weights: Array, dual: Point, knots: Array) -> None:
    lx, ly = dual
    for k in range(starts.size - 1):
        cell = cells[k]
        p, q = cell[2] * lx + cell[3] * ly, cell[4] * lx + cell[5] * ly
        for knot in range(starts[k], starts[k + 1]):
            u = min(cell[9], max(cell[8], cell[6] + weights[knot] * p))
            v = min(cell[11], max(cell[10], cell[7] + weights[knot] * q))
            knots[knot, 1] = cell[0] + cell[2] * u + cell[4] * v
            knots[knot, 2] = cell[1] + cell[3] * u + cell[5] * v


@compiled
def _newton(
    cells: Array, starts: Indices, weights: Array, x: float, y: float, lx: float, ly: float
) -> tuple[int, float, float, int]:
    """Return 1 for solved, -1 for infeasible, 0 for not converged; λ; evaluations."""
    gx, gy, xx, xy, yy = _gradient(cells, starts, weights, lx, ly)
    gx, gy = gx - x, gy - y
    outcome, evaluations = 0, 1
    for _ in range(ITERATIONS):
        size = gx * gx + gy * gy
        if size < SOLVED * SOLVED:
            outcome = 1
            break
        if _beyond(cells, starts, x, y, -gx, -gy):
            outcome = -1
            break
        # Regularized in directions in which all knots are at their bounds.
        small = 1e-9 * (xx + yy) + 1e-12
        xx, yy = xx + small, yy + small
        det = xx * yy - xy * xy
        sx, sy = (xy * gy - yy * gx) / det, (xy * gx - xx * gy) / det
        nearer = False
        for _half in range(HALVINGS):
            gx, gy, xx, xy, yy = _gradient(cells, starts, weights, lx + sx, ly + sy)
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
def _beyond(cells: Array, starts: Indices, x: float, y: float, dx: float, dy: float) -> bool:
    """Whether the boxes do not reach the DCM in a direction."""
    reach = 0.0
    for k in range(starts.size - 1):
        cell = cells[k]
        p, q = cell[2] * dx + cell[3] * dy, cell[4] * dx + cell[5] * dy
        reach += cell[12] * (p * (cell[9] if p > 0.0 else cell[8]))
        reach += cell[12] * (q * (cell[11] if q > 0.0 else cell[10]))
    return reach < dx * x + dy * y


@compiled
def _gradient(
    cells: Array, starts: Indices, weights: Array, lx: float, ly: float
) -> tuple[float, float, float, float, float]:
    """Return Σ w M u, x, y [m], and its derivative xx, xy, yy by λ."""
    gx = gy = xx = xy = yy = 0.0
    for k in range(starts.size - 1):
        cell = cells[k]
        own = weights[starts[k] : starts[k + 1]]
        ax, ay, bx, by = cell[2], cell[3], cell[4], cell[5]
        u, uu = _along(cell, own, cell[6], ax * lx + ay * ly, cell[8], cell[9])
        v, vv = _along(cell, own, cell[7], bx * lx + by * ly, cell[10], cell[11])
        gx += ax * u + bx * v
        gy += ay * u + by * v
        xx += ax * ax * uu + bx * bx * vv
        xy += ax * ay * uu + bx * by * vv
        yy += ay * ay * uu + by * by * vv
    return gx, gy, xx, xy, yy


@compiled
def _along(
    cell: Array, weights: Array, nominal: float, slope: float, low: float, high: float
) -> Point:
    """Return Σ w clip(nominal + w slope) over the knots of a cell, and its derivative."""
    if low <= nominal <= high and low <= nominal + cell[14] * slope <= high:
        return cell[12] * nominal + cell[13] * slope, cell[13]
    moved = change = 0.0
    for w in weights:
        u = nominal + w * slope
        if u < low:
            moved += w * low
        elif u > high:
            moved += w * high
        else:
            moved += w * u
            change += w * w
    return moved, change
