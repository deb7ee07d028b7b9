"""Program of ZMP planning: knots nearest to a reference under a DCM constraint, compiled.

The ZMP is linear between knots at absolute times. A knot of a single support is in the sole, one of
a double support in a parallelogram within the hull of the soles, the last one on the next support
sole. With the weights w_j of the knots in the present DCM the program is

    minimize Σ |u_j - û_j|²  subject to  Σ w_j (centre_j + M_j u_j) = DCM,  u_j in its box.

Knots in the same parallelogram are a *cell*, a row of

    centre x, y [m] | sides ax, ay, bx, by, the columns of M [1] | nominal u, v |
    low u, high u, low v, high v [m] | Σ w, Σ w², max w of its knots [1];

`starts` (n + 1,) holds the index of the first knot of every cell, `weights` those of all knots.
"""

from math import cos, exp, sin, sqrt

import numpy as np

from compilation import compiled
from walking.arrays import Array, Indices, Point, Vector
from walking.pattern.pendulum_kernel import Pendulum, Tick

Sole = tuple[float, float, float]
"""Centre ahead of the ankle, half of length and width minus the margin of the knots [m]."""

SINGLE_SPACING = 9  # ticks between knots in single support
LATER_SPACING = 27  # ticks between knots in the single support after that
DOUBLE_SPACING = 18  # ticks between knots in a long double support
REST = 72  # ticks of standing at the end of a plan
CELL = 15  # columns of a cell


@compiled
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
    knots, weights = np.zeros((capacity, 3)), np.empty(capacity)
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


@compiled
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


@compiled
def limit(cell: Array, x: float, y: float, reach: float) -> None:
    """Limit the box of a cell to within `reach` of a point along both sides [m]."""
    u, v = sides(cell, x - cell[0], y - cell[1])
    u, v = min(cell[9], max(cell[8], u)), min(cell[11], max(cell[10], v))
    cell[8], cell[9] = max(cell[8], u - reach), min(cell[9], u + reach)
    cell[10], cell[11] = max(cell[10], v - reach), min(cell[11], v + reach)


@compiled
def sides(cell: Array, x: float, y: float) -> Point:
    """Return the coordinates of a vector along the sides of a cell."""
    ax, ay, bx, by = cell[2], cell[3], cell[4], cell[5]
    scale = ax * by - ay * bx
    return (x * by - y * bx) / scale, (y * ax - x * ay) / scale


@compiled
def _ramp(wh: float, ticks: float) -> Vector:
    """See `Lipm.ramp`."""
    if ticks == 0.0:
        return 1.0, 0.0, 0.0
    growth = exp(wh * ticks)
    last = (growth - 1.0) / (wh * ticks) - 1.0
    return growth, growth - 1.0 - last, last


@compiled
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


@compiled
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
                between(ramp, 1.0 - (left - index * spacing) / ticks, sole, cells[count])
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


@compiled
def _stands_on(ramp: Array, before: Array) -> bool:
    """Whether a ramp is the single support on the loading foot of the previous ramp."""
    same = True
    for k in range(4):
        same = same and ramp[5 + k] == before[9 + k] and ramp[9 + k] == before[9 + k]
    return same


@compiled
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


@compiled
def between(ramp: Array, elapsed: float, sole: Sole, cell: Array) -> None:
    """Set a cell to a parallelogram between the outer edges of two soles."""
    centre, length, width = sole
    first, second = ramp[5:9], ramp[9:13]
    middle = 0.5 * (first[2] + second[2])
    # With soles at an angle, shortened so that the edges stay in the soles.
    slant = abs(sin(0.5 * (first[2] - second[2])))
    length = min(length, width / slant) if slant > 0.0 else length
    ax, ay = _edge(first, centre, width - length * slant)
    bx, by = _edge(second, centre, width - length * slant)
    dx, dy = bx - ax, by - ay
    span = sqrt(dx * dx + dy * dy)
    cx, cy = 0.5 * (ax + bx), 0.5 * (ay + by)
    cell[0], cell[1] = cx, cy
    cell[2], cell[3] = cos(middle), sin(middle)
    cell[4], cell[5] = dx / span, dy / span
    x = ramp[1] + elapsed * (ramp[3] - ramp[1])
    y = ramp[2] + elapsed * (ramp[4] - ramp[2])
    cell[6], cell[7] = sides(cell, x - cx, y - cy)
    cell[8], cell[9], cell[10], cell[11] = -length, length, -0.5 * span, 0.5 * span


@compiled
def _edge(foot: Array, centre: float, outward: float) -> Point:
    """Return a point on the outer side of a sole [m]."""
    c, s = cos(foot[2]), sin(foot[2])
    across = outward if foot[3] > 0.0 else -outward
    return foot[0] + centre * c - s * across, foot[1] + centre * s + c * across


@compiled
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


@compiled
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


@compiled
def _sum_up(cells: Array, starts: Indices, count: int, weights: Array) -> None:
    for k in range(count):
        total = squares = max_weight = 0.0
        for knot in range(starts[k], starts[k + 1]):
            w = weights[knot]
            total += w
            squares += w * w
            max_weight = max(max_weight, w)
        cells[k, 12], cells[k, 13], cells[k, 14] = total, squares, max_weight
