"""ZMP planning: knots nearest to a reference under a DCM constraint, compiled.

The ZMP is linear between knots at absolute times. A knot of a single support is in the sole, one of
a double support in a parallelogram within the hull of the soles, the last one on the next support
sole. With the weights w_j of the knots in the present DCM the program is

    minimize Σ |u_j - û_j|²  subject to  Σ w_j (centre_j + M_j u_j) = DCM,  u_j in its box.

The dual has one unknown per axis, λ, with u_j = clip(û_j + w_j M_jᵀ λ); its gradient is piecewise
linear and solved by Newton's method with step halving. An infeasible program is detected early: the
boxes do not reach the DCM in the direction of the residual.

Knots that fraction a parallelogram are a *cell*, a row of

    centre x, y [m] | sides ax, ay, bx, by, the columns of M [1] | nominal u, v |
    low u, high u, low v, high v [m] | Σ w, Σ w², max w of its knots [1];

`starts` (n + 1,) holds the index of the first knot of every cell, `weights` those of all knots.

`plan` calls `lay_out` (cells, times and weights of knots), `solve` (λ) and `set_points` (knot
positions); `follow` advances the pendulum along the plan.
"""

from math import cos, exp, hypot, sin

import numpy as np
from numba import njit

from walking.arrays import Array, Indices, Point

Pendulum = tuple[float, float, float, float, float, float]
"""Position x, y [m], velocity x, y [m/s], ZMP of the last tick x, y [m]."""

Sole = tuple[float, float, float]
"""Centre ahead of the ankle, half of length and width minus the margin of the knots [m]."""

Tick = tuple[float, float, float, float]
"""Control tick of the pendulum, see `Lipm.tick`."""

SOLVED = 1e-10  # maximum residual of the DCM [m]
ITERATIONS = 20
HALVINGS = 6
SINGLE_SPACING = 9  # ticks between knots in single support
LATER_SPACING = 27  # ticks between knots in the single support after that
DOUBLE_SPACING = 18  # ticks between knots in a long double support
REST = 72  # ticks of standing at the end of a plan
CELL = 15  # columns of a cell


@njit(cache=True)
def plan(
    ramps: Array, pendulum: Pendulum, sole: Sole, tick: Tick, rate: float, dual: Point
) -> tuple[bool, Point, int, Array]:
    """Set up and solve the program of a plan near a reference.

    Arguments as in `lay_out`; `dual` is the initial guess of λ [1/m].

    Returns:
        whether the program is feasible, λ [1/m], number of evaluations of the gradient, and the
        knots, see `lay_out` (m, 3).
    """
    cells, starts, weights, dcm_now, knots = lay_out(ramps, pendulum, sole, tick, rate)
    feasible, lx, ly, evaluations = solve(cells, starts, weights, dcm_now[0], dcm_now[1], dual)
    set_points(cells, starts, weights, (lx, ly), knots)
    return feasible, (lx, ly), evaluations, knots


@njit(cache=True)
def follow(knots: Array, begin: int, pendulum: Pendulum, tick: Tick) -> tuple[Pendulum, int]:
    """Advance the pendulum by a tick along a plan.

    Args:
        knots: ticks since the previous knot, at `begin` the remaining ticks; x, y [m] (n, 3).
        begin: index of the next knot; beyond the last the ZMP stays.
        pendulum: present.
        tick: of the pendulum.

    Returns:
        the pendulum and the index of the next knot, a tick later.
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
def _slide(position: float, velocity: float, before: float, after: float, tick: Tick) -> Point:
    """Return position [m] and velocity [m/s] one tick later under a linearly moving ZMP."""
    w, c, s, period = tick
    rate = (after - before) / period
    # The ZMP is a particular solution of the equation of motion.
    d, v = position - before, velocity - rate
    return after + d * c + v / w * s, rate + d * w * s + v * c


@njit(cache=True)
def lay_out(
    ramps: Array, pendulum: Pendulum, sole: Sole, tick: Tick, rate: float
) -> tuple[Array, Indices, Array, Point, Array]:
    """Set up the program of a plan near a reference.

    Args:
        ramps: reference, see `walking.pattern.ramps` (n, 13).
        pendulum: present.
        sole: of each foot.
        tick: of the pendulum.
        rate: maximum change of the ZMP per tick in single support [m].

    Returns:
        cells, their `starts`, `weights`, the DCM of the constraint [m], and the knots: ticks since
        the previous knot; x, y of the last, the end of the plan [m] (m, 3).
    """
    wh = tick[0] * tick[3]
    near = _near(ramps)
    ends = near > ramps.shape[0]
    last = ramps[min(near, ramps.shape[0]) - 1]
    end_x, end_y = last[3], last[4]
    rest_x, rest_y = end_x, end_y
    if near < ramps.shape[0]:
        rest_x, rest_y = dcm(ramps[near:], wh)
    table = ramps[:near]
    if ends:
        # Extended by standing at its end, with the feet of the last ramp.
        table = np.empty((near, ramps.shape[1]))
        for column in range(ramps.shape[1]):
            for k in range(near):
                table[k, column] = ramps[min(k, near - 2), column]
        table[-1, 0], table[-1, 1], table[-1, 2] = REST, end_x, end_y
    capacity = 3
    for ramp in table:
        capacity += int(ramp[0]) // SINGLE_SPACING + 2
    cells, starts = np.empty((capacity, CELL)), np.empty(capacity + 1, np.int64)
    knots, weights = np.empty((capacity, 3)), np.empty(capacity)
    count = _lay_cells(table, sole, cells, starts, knots)
    if count > 0 and table[0, 8] == table[0, 12]:
        reach = rate * knots[0, 0]
        count = _limit_first(cells, starts, count, pendulum[4], pendulum[5], reach)
    number = starts[count]
    left = 0.0
    for ramp in table:
        left += ramp[0]
    for knot in range(number):
        left -= knots[knot, 0]
    knots[number, 0], knots[number, 1], knots[number, 2] = left, end_x, end_y
    x, y = _weigh(knots[: number + 1], weights, pendulum, rest_x, rest_y, tick)
    _sum_up(cells, starts, count, weights)
    return cells[:count], starts[: count + 1], weights[:number], (x, y), knots[: number + 1]


@njit(cache=True)
def dcm(ramps: Array, wh: float) -> Point:
    """Return the DCM from which a reference can be walked for ever: the backward recursion [m].

    Args:
        ramps: reference (n, 13).
        wh: ω times the control period [1].
    """
    x, y = ramps[-1, 3], ramps[-1, 4]
    for k in range(ramps.shape[0] - 1, -1, -1):
        growth, first, last = _ramp(wh, ramps[k, 0])
        x = (x + first * ramps[k, 1] + last * ramps[k, 3]) / growth
        y = (y + first * ramps[k, 2] + last * ramps[k, 4]) / growth
    return x, y


@njit(cache=True)
def limit(cell: Array, x: float, y: float, reach: float) -> None:
    """Limit the box of a cell to within `reach` of a point along both sides [m]."""
    u, v = sides(cell, x - cell[0], y - cell[1])
    u, v = min(cell[9], max(cell[8], u)), min(cell[11], max(cell[10], v))
    cell[8], cell[9] = max(cell[8], u - reach), min(cell[9], u + reach)
    cell[10], cell[11] = max(cell[10], v - reach), min(cell[11], v + reach)


@njit(cache=True)
def sides(cell: Array, x: float, y: float) -> Point:
    """Return the coordinates of a vector along the sides of a cell."""
    ax, ay, bx, by = cell[2], cell[3], cell[4], cell[5]
    scale = ax * by - ay * bx
    return (x * by - y * bx) / scale, (y * ax - x * ay) / scale


@njit(cache=True)
def _ramp(wh: float, ticks: float) -> tuple[float, float, float]:
    """See `Lipm.ramp`."""
    if ticks == 0.0:
        return 1.0, 0.0, 0.0
    growth = exp(wh * ticks)
    last = (growth - 1.0) / (wh * ticks) - 1.0
    return growth, growth - 1.0 - last, last


@njit(cache=True)
def _near(ramps: Array) -> int:
    """Return the number of ramps whose ZMP is planned.

    They end with the double support after the second single support. For a shorter reference the
    number is one more than its ramps: `lay_out` appends standing.
    """
    singles = 0
    for k in range(ramps.shape[0] - 1):
        if ramps[k, 8] == ramps[k, 12]:
            singles += 1
        if singles == 2:
            return k + 2
    return int(ramps.shape[0]) + 1


@njit(cache=True)
def _lay_cells(ramps: Array, sole: Sole, cells: Array, starts: Indices, knots: Array) -> int:
    """Set cells and times of the knots; return the number of cells.

    A single support has one cell, shared with the last knot of the double support before it; every
    other knot of a double support has a separate cell.

    Args:
        ramps: whose ZMP is planned (n, 13).
        sole: of each foot.
        cells: set, except for the sums of weights.
        starts: set.
        knots: ticks since the previous knot are set.
    """
    # Ticks from the last knot to the begin of the ramp; knots pending for the next sole's cell.
    since, carried = 0, 0
    every, count, knot = SINGLE_SPACING, 0, 0
    starts[0] = 0
    for k in range(ramps.shape[0]):
        ramp, ticks = ramps[k], int(ramps[k, 0])
        final = k == ramps.shape[0] - 1
        single = ramp[8] == ramp[12]
        # The last knot is on the next sole, in the cell of the single support there.
        lands = not (single or final) and _stands_on(ramps[k + 1], ramp)
        spacing = every if single else DOUBLE_SPACING
        # Counted from the end: the times of knots are the same in every tick.
        left = (ticks - 1) // spacing * spacing
        here = left // spacing + (0 if final or lands else 1)
        if single:
            if here + carried:
                _on_sole(ramp, sole, cells[count])
                starts[count + 1] = starts[count] + carried + here
                count += 1
            carried = 0
            every = LATER_SPACING
        else:
            for index in range(here):
                _between(ramp, 1.0 - (left - index * spacing) / ticks, sole, cells[count])
                starts[count + 1] = starts[count] + 1
                count += 1
            if lands:
                carried = 1
                here += 1
        for index in range(here):
            ahead = max(0, left - index * spacing)
            knots[knot, 0] = since + ticks - ahead
            since = ahead - ticks
            knot += 1
        since += ticks
    return count


@njit(cache=True)
def _stands_on(ramp: Array, before: Array) -> bool:
    """Whether a ramp is the single support on the loading foot of the previous ramp."""
    same = True
    for k in range(4):
        same = same and ramp[5 + k] == before[9 + k] and ramp[9 + k] == before[9 + k]
    return same


@njit(cache=True)
def _on_sole(ramp: Array, sole: Sole, cell: Array) -> None:
    """Set a cell to the rectangle of the support sole."""
    centre, length, width = sole
    c, s = cos(ramp[7]), sin(ramp[7])
    cx, cy = ramp[5] + centre * c, ramp[6] + centre * s
    dx, dy = ramp[1] - cx, ramp[2] - cy
    cell[0], cell[1] = cx, cy
    cell[2], cell[3], cell[4], cell[5] = c, s, -s, c
    cell[6], cell[7] = c * dx + s * dy, c * dy - s * dx
    cell[8], cell[9], cell[10], cell[11] = -length, length, -width, width


@njit(cache=True)
def _between(ramp: Array, elapsed: float, sole: Sole, cell: Array) -> None:
    """Set a cell to a parallelogram between the outer edges of two soles."""
    centre, length, width = sole
    first, second = ramp[5:9], ramp[9:13]
    middle = 0.5 * (first[2] + second[2])
    # With soles at an angle, shortened so that the edges stay in the soles.
    slant = abs(sin(0.5 * (first[2] - second[2])))
    length = min(length, width / slant) if slant > 0.0 else length
    ax, ay = _edge(first, centre, width - length * slant)
    bx, by = _edge(second, centre, width - length * slant)
    span = hypot(bx - ax, by - ay)
    cx, cy = 0.5 * (ax + bx), 0.5 * (ay + by)
    cell[0], cell[1] = cx, cy
    cell[2], cell[3] = cos(middle), sin(middle)
    cell[4], cell[5] = (bx - ax) / span, (by - ay) / span
    x = ramp[1] + elapsed * (ramp[3] - ramp[1])
    y = ramp[2] + elapsed * (ramp[4] - ramp[2])
    cell[6], cell[7] = sides(cell, x - cx, y - cy)
    cell[8], cell[9], cell[10], cell[11] = -length, length, -0.5 * span, 0.5 * span


@njit(cache=True)
def _edge(foot: Array, centre: float, outward: float) -> Point:
    """Return a point on the outer side of a sole [m]."""
    c, s = cos(foot[2]), sin(foot[2])
    across = outward if foot[3] > 0.0 else -outward
    return foot[0] + centre * c - s * across, foot[1] + centre * s + c * across


@njit(cache=True)
def _limit_first(
    cells: Array, starts: Indices, count: int, x: float, y: float, reach: float
) -> int:
    """Limit the first knot to within reach of the ZMP, in a separate cell; return the cell count.

    `cells` must have capacity for one more cell.
    """
    if starts[1] > 1:
        for k in range(count, 0, -1):
            for column in range(CELL):
                cells[k, column] = cells[k - 1, column]
            starts[k + 1] = starts[k]
        starts[1] = 1
        count += 1
    limit(cells[0], x, y, reach)
    return count


@njit(cache=True)
def _weigh(
    knots: Array, weights: Array, pendulum: Pendulum, rest_x: float, rest_y: float, tick: Tick
) -> Point:
    """Set the weights of all knots except the last; return the DCM of their constraint [m].

    Args:
        knots: the last is the end of the plan.
        weights: set.
        pendulum: present.
        rest_x: x of the DCM of the rest of the reference [m].
        rest_y: y of the DCM of the rest of the reference [m].
        tick: of the pendulum.
    """
    x, y, vx, vy, zmp_x, zmp_y = pendulum
    omega, wh = tick[0], tick[0] * tick[3]
    growth, first, last = _ramp(wh, knots[0, 0])
    decay = 1.0 / growth
    now, weight = decay * first, decay * last
    for knot in range(1, knots.shape[0]):
        growth, first, last = _ramp(wh, knots[knot, 0])
        decay /= growth
        weights[knot - 1] = weight + decay * first
        weight = decay * last
    end = knots[-1]
    return (
        x + vx / omega - now * zmp_x - weight * end[1] - decay * rest_x,
        y + vy / omega - now * zmp_y - weight * end[2] - decay * rest_y,
    )


@njit(cache=True)
def _sum_up(cells: Array, starts: Indices, count: int, weights: Array) -> None:
    for k in range(count):
        total = squares = max_weight = 0.0
        for knot in range(starts[k], starts[k + 1]):
            w = weights[knot]
            total += w
            squares += w * w
            max_weight = max(max_weight, w)
        cells[k, 12], cells[k, 13], cells[k, 14] = total, squares, max_weight


@njit(cache=True)
def solve(
    cells: Array, starts: Indices, weights: Array, x: float, y: float, start: Point
) -> tuple[bool, float, float, int]:
    """Solve for λ.

    Args:
        cells: of the knots.
        starts: of the knots in the cells.
        weights: of the knots.
        x: x of the DCM constraint [m].
        y: y of the DCM constraint [m].
        start: initial guess of λ [1/m].

    Returns:
        whether the program is feasible, λ [1/m], and number of evaluations of the gradient.
    """
    for k in range(starts.size - 1):
        x -= cells[k, 12] * cells[k, 0]
        y -= cells[k, 12] * cells[k, 1]
    outcome, lx, ly, evaluations = _newton(cells, starts, weights, x, y, start[0], start[1])
    if outcome == 0 and (start[0] != 0.0 or start[1] != 0.0):
        # With all knots at their bounds the derivative is zero.
        outcome, lx, ly, more = _newton(cells, starts, weights, x, y, 0.0, 0.0)
        evaluations += more
    return outcome == 1, lx, ly, evaluations


@njit(cache=True)
def set_points(cells: Array, starts: Indices, weights: Array, dual: Point, knots: Array) -> None:
    """Set x, y [m] of the knots of a solution, the last two columns of `knots`."""
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


@njit(cache=True)
def _beyond(cells: Array, starts: Indices, x: float, y: float, dx: float, dy: float) -> bool:
    """Whether the boxes do not reach the DCM in a direction."""
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


@njit(cache=True)
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
