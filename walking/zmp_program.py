"""Program of a ZMP plan: knots, their cells and weights, see `walking.zmp_plan`."""

from math import cos, sin, sqrt
from typing import NamedTuple

import numpy as np

from compilation import compiled
from walking.footsteps import equal
from walking.parameters import CONTROL_PERIOD
from walking.pendulum import dcm_reference, ramp_weights
from walking.plane import Array, Point, from_frame
from walking.records import Record
from walking.reference import RAMP, is_single
from walking.zmp_solver import CELL, KNOT

SINGLE_SPACING = 9  # ticks between knots in single support

LATER_SPACING = 27  # ticks between knots in the single support after that

DOUBLE_SPACING = 18  # ticks between knots in a long double support

REST = 72  # ticks of standing at the end of a plan

ENDS = 3  # knots beyond those of the ramps


class Sole(NamedTuple):
    """Sole for the knots.

    Attributes:
        centre: middle of the sole ahead of the ankle [m].
        length, width: half of length and width minus the margin of the knots [m].
    """

    centre: float
    length: float
    width: float


class Program(NamedTuple):
    """Quadratic program of a plan.

    Attributes:
        cells: cells of the knots, see `CELL` (n,).
        weights: weights of the knots in the DCM (m,) [1].
        knots: knots (m + 1,), the last one the end of the plan.
        dcm: right side of the equation [m].
    """

    cells: Record
    weights: Array
    knots: Record
    dcm: Point


@compiled
def max_knots(ticks: int, supports: int) -> int:
    """Return an upper bound of the knots of a plan of a number of ticks and supports."""
    return ENDS + (ticks + REST) // SINGLE_SPACING + 2 * (supports + 1)


@compiled
def lay_out(ramps: Record, pendulum: Record, sole: Sole, robot: Record, reach: float) -> Program:
    """Set up the program of a plan near a reference.

    Args:
        ramps: reference.
        pendulum: present pendulum.
        sole: sole of each foot.
        robot: constants.
        reach: maximum change of the ZMP per tick in single support [m].
    """
    planned, count = _planned_ramps(ramps), len(ramps)
    ends = planned > count
    last = ramps[min(planned, count) - 1]
    end_x, end_y = last.bx, last.by
    rest = (end_x, end_y)
    if planned < count:
        rest = dcm_reference(ramps[planned:], robot)
    table = ramps[:planned]
    if ends:
        # Extended by standing at its end, with the feet of the last ramp.
        table = np.empty(planned, RAMP)
        for k in range(count):
            table[k] = ramps[k]
        table[count] = ramps[count - 1]
        table[count].ticks = REST
        table[count].ax, table[count].ay = end_x, end_y
    total = 0
    for k in range(planned):
        total += table[k].ticks
    capacity = max_knots(total, planned)
    cells, knots = np.empty(capacity, CELL), np.zeros(capacity, KNOT)
    number = _lay_cells(table, sole, cells, knots)
    if number > 0 and is_single(table[0]):
        number = _limit_first(cells, number, pendulum.zmp_x, pendulum.zmp_y, reach * knots[0].ticks)
    inner = cells[number - 1].end if number > 0 else 0
    left = float(total)
    for knot in range(inner):
        left -= knots[knot].ticks
    knots[inner].ticks, knots[inner].x, knots[inner].y = left, end_x, end_y
    weights = np.empty(inner)
    dcm = _weigh(knots[: inner + 1], weights, pendulum, rest, robot)
    _sum_up(cells[:number], weights)
    return Program(cells[:number], weights, knots[: inner + 1], dcm)


@compiled
def limit_cell(cell: Record, x: float, y: float, reach: float) -> None:
    """Limit the box of a cell to within `reach` of a point along both sides [m]."""
    u, v = along_sides(cell, x - cell.x, y - cell.y)
    u, v = min(cell.high_u, max(cell.low_u, u)), min(cell.high_v, max(cell.low_v, v))
    cell.low_u, cell.high_u = max(cell.low_u, u - reach), min(cell.high_u, u + reach)
    cell.low_v, cell.high_v = max(cell.low_v, v - reach), min(cell.high_v, v + reach)


@compiled
def along_sides(cell: Record, x: float, y: float) -> Point:
    """Return the coordinates of a vector along the sides of a cell."""
    scale = cell.ax * cell.by - cell.ay * cell.bx
    return (x * cell.by - y * cell.bx) / scale, (y * cell.ax - x * cell.ay) / scale


@compiled
def _planned_ramps(ramps: Record) -> int:
    """Return the number of ramps whose ZMP is planned.

    They end with the double support after the second single support. For a shorter reference the
    number is one more than its ramps: `lay_out` appends standing.
    """
    singles = 0
    for k in range(len(ramps) - 1):
        if is_single(ramps[k]):
            singles += 1
        if singles == 2:
            return k + 2
    return len(ramps) + 1


@compiled
def _lay_cells(ramps: Record, sole: Sole, cells: Record, knots: Record) -> int:
    """Set cells and times of the knots; return the number of cells.

    A single support has one cell, shared with the last knot of the double support before it; every
    other knot of a double support has a separate cell.

    Args:
        ramps: ramps whose ZMP is planned.
        sole: sole of each foot.
        cells: set, except for the sums of weights.
        knots: ticks since the previous knot are set.
    """
    # Ticks from the last knot to the begin of the ramp; knots pending for the next sole's cell.
    since, carried = 0, 0
    every, number, knot, begin = SINGLE_SPACING, 0, 0, 0
    for k in range(len(ramps)):
        ramp, ticks = ramps[k], ramps[k].ticks
        final, single = k == len(ramps) - 1, is_single(ramp)
        # The last knot is on the next sole, in the cell of the single support there.
        lands = not (single or final) and _stands_on(ramps[k + 1], ramp)
        spacing = every if single else DOUBLE_SPACING
        # Counted from the end: the times of knots are the same in every tick.
        left = (ticks - 1) // spacing * spacing
        here = left // spacing + (0 if final or lands else 1)
        if single:
            if here + carried > 0:
                _put_on_sole(ramp, sole, cells[number])
                cells[number].begin, cells[number].end = begin, begin + carried + here
                begin += carried + here
                number += 1
            carried = 0
            every = LATER_SPACING
        else:
            for index in range(here):
                elapsed = 1.0 - (left - index * spacing) / ticks
                put_between(ramp, elapsed, sole, cells[number])
                cells[number].begin, cells[number].end = begin, begin + 1
                begin += 1
                number += 1
            if lands:
                carried = 1
                here += 1
        for index in range(here):
            ahead = max(0, left - index * spacing)
            knots[knot].ticks = since + ticks - ahead
            since = ahead - ticks
            knot += 1
        since += ticks
    return number


@compiled
def _stands_on(ramp: Record, before: Record) -> bool:
    """Whether a ramp is the single support on the loading foot of the previous ramp."""
    return equal(ramp.unloading, before.loading) and equal(ramp.loading, before.loading)


@compiled
def _put_on_sole(ramp: Record, sole: Sole, cell: Record) -> None:
    """Set a cell to the rectangle of the support sole."""
    foot = ramp.unloading
    c, s = cos(foot.yaw), sin(foot.yaw)
    cx, cy = foot.x + sole.centre * c, foot.y + sole.centre * s
    dx, dy = ramp.ax - cx, ramp.ay - cy
    cell.x, cell.y = cx, cy
    cell.ax, cell.ay, cell.bx, cell.by = c, s, -s, c
    cell.nominal_u, cell.nominal_v = c * dx + s * dy, c * dy - s * dx
    cell.low_u, cell.high_u = -sole.length, sole.length
    cell.low_v, cell.high_v = -sole.width, sole.width


@compiled
def put_between(ramp: Record, elapsed: float, sole: Sole, cell: Record) -> None:
    """Set a cell to a parallelogram between the outer edges of two soles.

    Args:
        ramp: double support.
        elapsed: part of its time until the knot [1].
        sole: sole of each foot.
        cell: set.
    """
    one, other, length = ramp.unloading, ramp.loading, sole.length
    middle = 0.5 * (one.yaw + other.yaw)
    # With soles at an angle, shortened so that the edges stay in the soles.
    slant = abs(sin(0.5 * (one.yaw - other.yaw)))
    if slant > 0.0:
        length = min(length, sole.width / slant)
    ax, ay = _edge(one, sole.centre, sole.width - length * slant)
    bx, by = _edge(other, sole.centre, sole.width - length * slant)
    dx, dy = bx - ax, by - ay
    span = sqrt(dx * dx + dy * dy)
    cx, cy = 0.5 * (ax + bx), 0.5 * (ay + by)
    cell.x, cell.y = cx, cy
    cell.ax, cell.ay = cos(middle), sin(middle)
    cell.bx, cell.by = dx / span, dy / span
    x = ramp.ax + elapsed * (ramp.bx - ramp.ax)
    y = ramp.ay + elapsed * (ramp.by - ramp.ay)
    cell.nominal_u, cell.nominal_v = along_sides(cell, x - cx, y - cy)
    cell.low_u, cell.high_u = -length, length
    cell.low_v, cell.high_v = -0.5 * span, 0.5 * span


@compiled
def _edge(foot: Record, centre: float, outward: float) -> Point:
    """Return a point on the outer side of a sole [m]."""
    return from_frame((foot.x, foot.y, foot.yaw), centre, outward if foot.left else -outward)


@compiled
def _limit_first(cells: Record, number: int, x: float, y: float, reach: float) -> int:
    """Limit the first knot to within reach of the ZMP, in a separate cell; return the cell count.

    `cells` must have capacity for one more cell.
    """
    if cells[0].end > 1:
        for k in range(number, 0, -1):
            cells[k] = cells[k - 1]
        cells[0].end = cells[1].begin = 1
        number += 1
    limit_cell(cells[0], x, y, reach)
    return number


@compiled
def _weigh(knots: Record, weights: Array, pendulum: Record, rest: Point, robot: Record) -> Point:
    """Set the weights of all knots except the last; return the DCM of their constraint [m].

    Args:
        knots: the last is the end of the plan.
        weights: set.
        pendulum: present pendulum.
        rest: DCM of the rest of the reference [m].
        robot: constants.
    """
    omega, wh = robot.omega, robot.omega * CONTROL_PERIOD
    growth, first, last = ramp_weights(wh, int(knots[0].ticks))
    decay = 1.0 / growth
    now, weight = decay * first, decay * last
    for knot in range(1, knots.shape[0]):
        growth, first, last = ramp_weights(wh, int(knots[knot].ticks))
        decay /= growth
        weights[knot - 1] = weight + decay * first
        weight = decay * last
    end, p = knots[knots.shape[0] - 1], pendulum
    return (
        p.x + p.vx / omega - now * p.zmp_x - weight * end.x - decay * rest[0],
        p.y + p.vy / omega - now * p.zmp_y - weight * end.y - decay * rest[1],
    )


@compiled
def _sum_up(cells: Record, weights: Array) -> None:
    for cell in cells:
        total = squares = max_weight = 0.0
        for knot in range(cell.begin, cell.end):
            w = weights[knot]
            total += w
            squares += w * w
            max_weight = max(max_weight, w)
        cell.weight, cell.square, cell.max_weight = total, squares, max_weight
