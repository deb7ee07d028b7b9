"""The program of the robust plan: knots of the ZMP as near to a reference as its DCM allows.

The ZMP is linear between knots at absolute times, so that they stay where they are as time goes
by. A knot of a single support lies in the sole, one of a double support in a parallelogram within
the hull of the two, its last one on the sole that carries next. With the weights w_j of the knots
in the DCM of now the program is

    minimize Σ |u_j - û_j|²  subject to  Σ w_j (centre_j + M_j u_j) = DCM,  u_j in its box.

The dual has one unknown per axis, λ, with u_j = clip(û_j + w_j M_jᵀ λ); its gradient is piecewise
linear and solved by Newton's method with step halving. That there is no solution shows early: the
boxes do not reach as far as the DCM in the direction that is missing.

The cells of the knots are those of `walking.zmp_layout_kernel`.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Point = tuple[float, float]

SOLVED = 1e-10  # DCM not accounted for that is rounding [m]
Pendulum = tuple[float, float, float, float, float, float]
"""Position x, y [m], velocity x, y [m/s], ZMP of the last tick x, y [m]."""

ITERATIONS = 20
HALVINGS = 6


@njit(cache=True)
def fit(
    cells: Array, starts: Indices, weights: Array, dcm: Point, dual: Point, knots: Array
) -> tuple[bool, float, float, int]:
    """Solve the program of a layout.

    Args:
        cells: of the knots.
        starts: of the cells' knots.
        weights: of the knots.
        dcm: that they bring about [m].
        dual: λ to begin with [1/m].
        knots: x, y [m] are set (n, 3).

    Returns:
        whether there is a solution, its λ [1/m], and how often the gradient was evaluated.
    """
    feasible, lx, ly, evaluations = solve(cells, starts, weights, dcm[0], dcm[1], dual)
    place(cells, starts, weights, (lx, ly), knots)
    return feasible, lx, ly, evaluations


@njit(cache=True)
def solve(
    cells: Array,
    starts: Indices,
    weights: Array,
    x: float,
    y: float,
    start: tuple[float, float],
) -> tuple[bool, float, float, int]:
    """Find λ, beginning at `start`.

    Args:
        cells: of the knots.
        starts: of the cells' knots.
        weights: of the knots.
        x: DCM that they bring about [m].
        y: the same [m].
        start: λ to begin with [1/m].

    Returns:
        whether the program is feasible, λ [1/m], and how often the gradient was evaluated.
    """
    for k in range(starts.size - 1):
        x -= cells[k, 12] * cells[k, 0]
        y -= cells[k, 12] * cells[k, 1]
    outcome, lx, ly, evaluations = _newton(cells, starts, weights, x, y, start[0], start[1])
    if outcome == 0 and (start[0] != 0.0 or start[1] != 0.0):
        # Where all knots are at their bounds Newton's method has nothing to go by.
        outcome, lx, ly, more = _newton(cells, starts, weights, x, y, 0.0, 0.0)
        evaluations += more
    return outcome == 1, lx, ly, evaluations


@njit(cache=True)
def place(
    cells: Array, starts: Indices, weights: Array, dual: tuple[float, float], knots: Array
) -> None:
    """Write x, y [m] of the knots of a solution into the last two columns of `knots`."""
    lx, ly = dual
    for k in range(starts.size - 1):
        cell = cells[k]
        p, q = cell[2] * lx + cell[3] * ly, cell[4] * lx + cell[5] * ly
        for knot in range(starts[k], starts[k + 1]):
            u = min(cell[9], max(cell[8], cell[6] + weights[knot] * p))
            v = min(cell[11], max(cell[10], cell[7] + weights[knot] * q))
            knots[knot, 1] = cell[0] + cell[2] * u + cell[4] * v
            knots[knot, 2] = cell[1] + cell[3] * u + cell[5] * v


@njit(cache=True)
def follow(
    knots: Array, begin: int, pendulum: Pendulum, tick: tuple[float, float, float, float]
) -> tuple[Pendulum, int]:
    """One tick along a plan.

    Args:
        knots: ticks since the one before, of that at `begin` those still to go; x, y [m] (n, 3).
        begin: index of the first knot to come; beyond the last the ZMP stays.
        pendulum: of now.
        tick: of the pendulum, see `Lipm`.

    Returns:
        the pendulum, and the first knot to come, a tick later.
    """
    x, y, vx, vy, zmp_x, zmp_y = pendulum
    px, py = zmp_x, zmp_y
    if begin < knots.shape[0]:
        knot = knots[begin]
        if knot[0] == 1.0:
            px, py = knot[1], knot[2]
            begin += 1
        else:
            px, py = px + (knot[1] - px) / knot[0], py + (knot[2] - py) / knot[0]
            knot[0] -= 1.0
    x, vx = _slide(x, vx, zmp_x, px, tick)
    y, vy = _slide(y, vy, zmp_y, py, tick)
    return (x, y, vx, vy, px, py), begin


@njit(cache=True)
def _slide(
    position: float,
    velocity: float,
    before: float,
    after: float,
    tick: tuple[float, float, float, float],
) -> Point:
    """Position [m] and velocity [m/s] one tick later under a ZMP moving linearly."""
    w, c, s, period = tick
    rate = (after - before) / period
    # The ZMP itself solves the equation of motion; what is left is free.
    d, v = position - before, velocity - rate
    return after + d * c + v / w * s, rate + d * w * s + v * c


@njit(cache=True)
def _newton(
    cells: Array, starts: Indices, weights: Array, x: float, y: float, lx: float, ly: float
) -> tuple[int, float, float, int]:
    """Solved (1), certainly infeasible (-1), or given up (0); λ; evaluations."""
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
        # Directions in which all knots are at their bounds stay where they are.
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


@njit(cache=True)
def _beyond(cells: Array, starts: Indices, x: float, y: float, dx: float, dy: float) -> bool:
    """Whether the DCM is out of reach of the boxes in a direction."""
    reach = 0.0
    for k in range(starts.size - 1):
        cell = cells[k]
        p, q = cell[2] * dx + cell[3] * dy, cell[4] * dx + cell[5] * dy
        reach += cell[12] * (p * (cell[9] if p > 0.0 else cell[8]))
        reach += cell[12] * (q * (cell[11] if q > 0.0 else cell[10]))
    return reach < dx * x + dy * y


@njit(cache=True)
def _gradient(
    cells: Array, starts: Indices, weights: Array, lx: float, ly: float
) -> tuple[float, float, float, float, float]:
    """Σ w M u, x, y [m], and its derivative xx, xy, yy by λ."""
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


@njit(cache=True)
def _along(
    cell: Array, weights: Array, nominal: float, slope: float, low: float, high: float
) -> tuple[float, float]:
    """Σ w clip(nominal + w slope) of a cell's knots, and its derivative by the slope."""
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
