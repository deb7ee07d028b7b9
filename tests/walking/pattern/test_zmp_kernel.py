"""ZMP planning: layout, solution of the quadratic program, and the pendulum along it."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from walking.foothold import Foothold
from walking.parameters import CONTROL_PERIOD
from walking.pattern import pendulum_kernel, zmp_layout_kernel, zmp_solver_kernel
from walking.pattern.lipm import Lipm
from walking.pattern.ramps import ZmpRamp, table_of
from walking.pattern.zmp_layout_kernel import CELL, limit, sides

NOMINAL = (0.005, -0.003)
BOUNDS = (-0.04, 0.04, -0.02, 0.02)
START = (0.0, 0.0)


class Fit:
    """A program of cells and a DCM."""

    def __init__(self, cells, x, y):
        self.cells, self.dcm, self.dual = cells, (x, y), START
        self.table = np.array([cell.row for cell in cells])
        self.starts = np.cumsum([0] + [len(cell.weights) for cell in cells])
        self.weights = np.concatenate([cell.weights for cell in cells])

    def solve(self, start):
        knots = np.zeros((self.weights.size, 3))
        args = (self.table, self.starts, self.weights, self.dcm, start, knots)
        solved, self.dual, self.evaluations = zmp_solver_kernel.solve(*args)
        self.points = knots[:, 1:].tolist()
        return solved


def cell_of(centre, angle, weights):
    c, s = float(np.cos(angle)), float(np.sin(angle))
    sums = (sum(weights), sum(w * w for w in weights), max(weights))
    row = (*centre, c, s, -s, c, *NOMINAL, *BOUNDS, *sums)
    return SimpleNamespace(
        centre=centre, axes=((c, s), (-s, c)), weights=weights, total=sums[0], row=row
    )


def box(centre, angle, nominal):
    """A cell without knots."""
    c, s = float(np.cos(angle)), float(np.sin(angle))
    return np.array([*centre, c, s, -s, c, *nominal, *BOUNDS, 0.0, 0.0, 0.0])


def draw(seed, reach):
    """Cells on feet of all directions, and a DCM at the fraction `reach` of the farthest."""
    rng = np.random.default_rng(seed)
    cells, farthest, k = [], np.zeros(2), 0
    for knots in (1, 4, 2, 1):
        angle = rng.uniform(-0.5, 0.5) if knots < 4 else 0.2
        cx, cy = rng.uniform(-0.1, 0.1, 2).tolist()
        cell = cell_of((cx, cy), angle, [float(0.3 * 0.6**j) for j in range(k, k + knots)])
        (c, s), _ = cell.axes
        k += knots
        corner = np.array([rng.choice(BOUNDS[:2]), rng.choice(BOUNDS[2:])]) * reach
        farthest += cell.total * (np.array([cx, cy]) + np.array([[c, -s], [s, c]]) @ corner)
        cells.append(cell)
    return cells, farthest.tolist()


def points_of(cells, fit):
    """Of every knot: weight, direction, point in the frame of its cell (n, 5), and Σ w p."""
    rows, total, points = [], np.zeros(2), iter(fit.points)
    for cell in cells:
        c, s = cell.axes[0]
        for weight in cell.weights:
            point = np.array(next(points))
            dx, dy = point - cell.centre
            rows.append([weight, c, s, c * dx + s * dy, c * dy - s * dx])
            total += weight * point
    return rows, total


@given(st.integers(0, 10**6), st.floats(0.0, 0.99))
def test_a_feasible_program_reaches_the_dcm_within_the_boxes(seed, reach):
    cells, dcm = draw(seed, reach)
    fit = Fit(cells, *dcm)
    assert fit.solve(START)
    assert fit.evaluations < 15
    rows, total = points_of(cells, fit)
    np.testing.assert_allclose(total, dcm, atol=2e-10)
    for *_, u, v in rows:
        assert BOUNDS[0] - 1e-12 <= u <= BOUNDS[1] + 1e-12
        assert BOUNDS[2] - 1e-12 <= v <= BOUNDS[3] + 1e-12


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.floats(0.0, 0.9))
def test_the_solution_satisfies_the_optimality_conditions(seed, reach):
    """The move is orthogonal to every direction that keeps DCM and boxes."""
    cells, dcm = draw(seed, reach)
    fit = Fit(cells, *dcm)
    fit.solve(START)
    free, columns = [], []
    for weight, c, s, u, v in points_of(cells, fit)[0]:
        for value, low, high, nominal, column in (
            (u, *BOUNDS[:2], NOMINAL[0], (c, s)),
            (v, *BOUNDS[2:], NOMINAL[1], (-s, c)),
        ):
            if low + 1e-9 < value < high - 1e-9:
                free.append(value - nominal)
                columns.append([weight * x for x in column])
    A, d = np.array(columns), np.array(free)
    if len(free) > 2:
        multiplier = np.linalg.lstsq(A, d, rcond=None)[0]
        np.testing.assert_allclose(A @ multiplier, d, atol=1e-7)


@given(st.integers(0, 10**6), st.floats(0.0, 0.9), st.floats(-300.0, 300.0))
def test_the_solution_does_not_depend_on_the_start(seed, reach, start):
    cells, dcm = draw(seed, reach)
    one, other = Fit(cells, *dcm), Fit(cells, *dcm)
    assert one.solve(START)
    assert other.solve((start, -start))
    np.testing.assert_allclose(other.points, one.points, atol=1e-8)


def test_the_solution_is_found_at_once_from_its_own_dual():
    cells, dcm = draw(5, 0.7)
    fit, again = Fit(cells, *dcm), Fit(cells, *dcm)
    fit.solve(START)
    again.solve(fit.dual)
    assert again.evaluations == 1


@given(st.integers(0, 10**6), st.floats(-3.1, 3.1), st.floats(1.001, 5.0))
def test_an_infeasible_program_is_detected(seed, direction, beyond):
    cells, _ = draw(seed, 0.0)
    towards = np.array([np.cos(direction), np.sin(direction)])
    middle, reach = np.zeros(2), 0.0
    for cell in cells:
        c, s = cell.axes[0]
        middle += cell.total * np.array(cell.centre)
        along, across = np.array([[c, s], [-s, c]]) @ towards
        reach += cell.total * (abs(along) * BOUNDS[1] + abs(across) * BOUNDS[3])
    fit = Fit(cells, *(middle + beyond * reach * towards).tolist())
    assert not fit.solve(START)


def test_the_rate_narrows_the_box_about_the_zmp():
    cell = box((0.0, 0.0), 0.0, (0.0, 0.0))
    limit(cell, 0.03, -0.01, 0.015)
    assert cell[8:12] == pytest.approx((0.015, 0.04, -0.02, 0.005))


def test_a_zmp_outside_its_cell_counts_as_on_its_edge():
    turned = box((0.1, 0.2), np.pi / 2, (0.0, 0.0))
    limit(turned, 0.1, 0.3, 0.015)  # 0.1 m ahead, the cell ends at 0.04 m
    assert turned[6:12] == pytest.approx((0.0, 0.0, 0.025, 0.04, -0.015, 0.015))


@given(st.floats(-0.1, 0.1), st.floats(-0.12, -0.07), st.floats(-0.6, 0.6), st.floats(-0.6, 0.6))
def test_a_cell_of_two_feet_has_two_edges_each_in_one_sole(x, y, yaw, other_yaw):
    ramp, cell, sole = np.zeros(13), np.zeros(CELL), (0.01, 0.05, 0.03)
    ramp[5:13] = 0.0, 0.0, yaw, 1.0, x, y, other_yaw, 0.0
    zmp_layout_kernel.between(ramp, 0.0, sole, cell)
    for v, foot in ((cell[10], ramp[5:8]), (cell[11], ramp[9:12])):
        c, s = np.cos(foot[2]), np.sin(foot[2])
        for u in cell[8:10]:
            corner = cell[:2] + u * cell[2:4] + v * cell[4:6] - foot[:2]
            ahead, left = c * corner[0] + s * corner[1], c * corner[1] - s * corner[0]
            assert abs(ahead - 0.01) <= 0.05 + 1e-9
            assert abs(left) <= 0.03 + 1e-9


@given(st.floats(-3.0, 3.0), st.floats(0.3, 2.8), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_the_coordinates_along_two_directions_lead_back(angle, between, x, y):
    a = (float(np.cos(angle)), float(np.sin(angle)))
    b = (2.0 * float(np.cos(angle + between)), 2.0 * float(np.sin(angle + between)))
    cell = np.zeros(CELL)
    cell[2:6] = *a, *b
    u, v = sides(cell, x, y)
    assert (a[0] * u + b[0] * v, a[1] * u + b[1] * v) == pytest.approx((x, y), abs=1e-9)


LIPM = Lipm(0.19)
SOLE = (0.01, 0.0345, 0.012)
RATE = 4.0 * CONTROL_PERIOD


def reference(rng, *, double, steps):
    """A walk on drawn feet from somewhere in a double or a single support on."""
    feet, turn = [], 0.0
    for k in range(steps + 2):
        turn += rng.uniform(-0.2, 0.2)
        at = (0.06 * k + rng.uniform(-0.01, 0.01), 0.042 * (-1.0) ** k)
        feet.append(Foothold(k % 2 == 0, *at, turn))
    points = [(f.x + 0.01 * np.cos(f.yaw), f.y + 0.01 * np.sin(f.yaw)) for f in feet]
    left = int(rng.integers(1, 58))
    ramps = [ZmpRamp(left, *points[1], *points[1], (feet[1], feet[1]))]
    if double:
        between = np.add(points[0], points[1]) / 2
        shift = ZmpRamp(int(rng.integers(1, 60)), *between, *points[1], (feet[0], feet[1]))
        ramps.insert(0, shift)
    for k in range(1, steps):
        pair = (feet[k], feet[k + 1])
        ramps.append(ZmpRamp(14, *points[k], *points[k + 1], pair))
        ramps.append(ZmpRamp(58, *points[k + 1], *points[k + 1], (pair[1], pair[1])))
    return ramps


def problem(seed):
    """Arguments of a program that is near to its reference."""
    rng = np.random.default_rng(seed)
    double, steps = bool(rng.integers(2)), int(rng.integers(1, 5))
    ramps = reference(rng, double=double, steps=steps)
    table = table_of(ramps)
    x, y = zmp_layout_kernel.dcm(table, LIPM.omega * CONTROL_PERIOD)
    off = rng.uniform(-0.006, 0.006, 4)
    zmp = (ramps[0].ax + 0.1 * off[0], ramps[0].ay + 0.1 * off[1])
    speed = LIPM.omega * (0.02 + off[2]), LIPM.omega * (-0.01 + off[3])
    pendulum = (x - 0.02 + off[0], y + 0.01 + off[1], *speed, *zmp)
    return ramps, (table, pendulum, SOLE, LIPM.tick, RATE)


def plan(arguments):
    """Whether the program is feasible, and its knots."""
    *program, knots = zmp_layout_kernel.lay_out(*arguments)
    return zmp_solver_kernel.solve(*program, START, knots)[0], knots


def moved(dcm, before, after, ticks):
    """DCM after a ZMP that went from one point to another: its equation of motion, integrated."""
    w, h = LIPM.omega, ticks * CONTROL_PERIOD
    slope = (after - before) / h
    return after + slope / w + np.exp(w * h) * (dcm - before - slope / w)


@given(st.integers(0, 10**6))
def test_along_the_knots_the_pendulum_comes_to_the_reference(seed):
    ramps, arguments = problem(seed)
    solved, knots = plan(arguments)
    if not solved:
        return
    x, y, vx, vy, *zmp = arguments[1]
    w = LIPM.omega
    dcm, now, ticks = np.array([x + vx / w, y + vy / w]), np.array(zmp), 0.0
    for knot in knots:
        dcm, now = moved(dcm, now, knot[1:], knot[0]), knot[1:]
        ticks += knot[0]
    while ramps and ticks > 0:
        ticks -= ramps.pop(0).ticks
    goal = zmp_layout_kernel.dcm(table_of(ramps), LIPM.omega * CONTROL_PERIOD) if ramps else now
    np.testing.assert_allclose(dcm, goal, atol=1e-6)  # a walk of a second multiplies by 1000


def test_most_of_those_programs_have_a_solution():
    assert sum(plan(problem(seed)[1])[0] for seed in range(100)) > 50


@given(st.integers(0, 10**6))
def test_knots_of_single_support_lie_in_their_sole(seed):
    ramps, arguments = problem(seed)
    solved, knots = plan(arguments)
    ends = np.cumsum([ramp.ticks for ramp in ramps])
    for time, (x, y) in zip(np.cumsum(knots[:, 0]), knots[:, 1:], strict=True):
        index = int(np.searchsorted(ends, time))
        if not solved or index == len(ramps) or ramps[index].feet[0] is not ramps[index].feet[1]:
            continue
        foot = ramps[index].feet[0]
        c, s = np.cos(foot.yaw), np.sin(foot.yaw)
        u, v = c * (x - foot.x) + s * (y - foot.y), c * (y - foot.y) - s * (x - foot.x)
        assert abs(u - SOLE[0]) <= SOLE[1] + 1e-12
        assert abs(v) <= SOLE[2] + 1e-12


def test_a_plan_is_followed_knot_by_knot_and_the_pendulum_obeys():
    knots = np.array([[2.0, 0.03, -0.01], [1.0, 0.01, 0.02]])
    zmps = [(0.02, -0.005), (0.03, -0.01), (0.01, 0.02), (0.01, 0.02)]
    begin, now = 0, (0.02, 0.01, -0.2, 0.1, 0.01, 0.0)
    for zmp in zmps:
        before = now
        now, begin = pendulum_kernel.follow(knots, begin, before, LIPM.tick)
        assert now[4:] == pytest.approx(zmp)
        for axis in range(2):
            p, rate = before[4 + axis], (zmp[axis] - before[4 + axis]) / CONTROL_PERIOD
            solution = solve_ivp(
                lambda t, s, p=p, rate=rate: [s[1], LIPM.omega**2 * (s[0] - p - rate * t)],
                (0.0, CONTROL_PERIOD),
                before[axis:4:2],
                rtol=1e-11,
                atol=1e-13,
            )
            assert solution.y[:, -1] == pytest.approx(now[axis:4:2], abs=1e-11)
    assert begin == len(knots)
