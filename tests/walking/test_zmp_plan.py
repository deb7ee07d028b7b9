"""ZMP planning: layout, solution of the quadratic program, and the pendulum along the knots."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from walking.footsteps import Foothold, foothold, put
from walking.parameters import CONTROL_PERIOD
from walking.patterns import PLAN
from walking.pendulum import PENDULUM, dcm_of, dcm_reference
from walking.reference import LIVE, RAMP, is_single, set_ramp
from walking.support import clip, support_region
from walking.zmp_plan import admits_knots, advance_knots, remains_feasible
from walking.zmp_program import Sole, along_sides, lay_out, limit_cell, put_between
from walking.zmp_solver import CELL, KNOT, solve

NOMINAL = (0.005, -0.003)
BOUNDS = (-0.04, 0.04, -0.02, 0.02)
START = (0.0, 0.0)
SOLE = Sole(0.01, 0.0345, 0.012)
REACH = 4.0 * CONTROL_PERIOD


def set_box(cell, centre, angle, nominal=NOMINAL):
    c, s = float(np.cos(angle)), float(np.sin(angle))
    cell.x, cell.y = centre
    cell.ax, cell.ay, cell.bx, cell.by = c, s, -s, c
    cell.nominal_u, cell.nominal_v = nominal
    cell.low_u, cell.high_u, cell.low_v, cell.high_v = BOUNDS


def draw(seed, reach):
    """Cells on feet of all directions, weights, and a DCM at a fraction of the farthest."""
    rng = np.random.default_rng(seed)
    cells, farthest, begin = np.zeros(4, CELL), np.zeros(2), 0
    weights = 0.3 * 0.6 ** np.arange(8.0)
    for cell, knots in zip(cells, (1, 4, 2, 1), strict=True):
        angle = rng.uniform(-0.5, 0.5) if knots < 4 else 0.2
        set_box(cell, rng.uniform(-0.1, 0.1, 2), angle)
        own = weights[begin : begin + knots]
        cell.begin, cell.end = begin, begin + knots
        cell.weight, cell.square, cell.max_weight = own.sum(), (own * own).sum(), own.max()
        begin += knots
        u, v = np.array([rng.choice(BOUNDS[:2]), rng.choice(BOUNDS[2:])]) * reach
        farthest += cell.weight * np.array(
            [cell.x + cell.ax * u + cell.bx * v, cell.y + cell.ay * u + cell.by * v]
        )
    return cells, weights, tuple(farthest.tolist())


def solved(cells, weights, dcm, start=START):
    knots = np.zeros(len(weights) + 1, KNOT)
    feasible, dual, evaluations = solve(cells, weights, dcm, start, knots)
    return feasible, dual, evaluations, np.column_stack([knots["x"], knots["y"]])[:-1]


def in_cells(cells, points):
    """Coordinates of every knot along the sides of its cell (n, 2), and the cells (n,)."""
    rows, owners = [], []
    for cell in cells:
        for x, y in points[cell.begin : cell.end].tolist():
            rows.append(along_sides(cell, x - cell.x, y - cell.y))
            owners.append(cell)
    return np.array(rows), owners


@given(st.integers(0, 10**6), st.floats(0.0, 0.99))
def test_a_feasible_program_reaches_the_dcm_within_the_boxes(seed, reach):
    cells, weights, dcm = draw(seed, reach)
    feasible, _, evaluations, points = solved(cells, weights, dcm)
    assert feasible
    assert evaluations < 15
    np.testing.assert_allclose(weights @ points, dcm, atol=2e-10)
    (u, v), _ = in_cells(cells, points)[0].T, None
    assert BOUNDS[0] - 1e-12 <= u.min() <= u.max() <= BOUNDS[1] + 1e-12
    assert BOUNDS[2] - 1e-12 <= v.min() <= v.max() <= BOUNDS[3] + 1e-12


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.floats(0.0, 0.9))
def test_the_solution_satisfies_the_optimality_conditions(seed, reach):
    """The move is orthogonal to every direction that keeps DCM and boxes."""
    cells, weights, dcm = draw(seed, reach)
    coordinates, owners = in_cells(cells, solved(cells, weights, dcm)[3])
    free, columns = [], []
    for (u, v), cell, weight in zip(coordinates, owners, weights, strict=True):
        for value, low, high, nominal, side in (
            (u, *BOUNDS[:2], NOMINAL[0], (cell.ax, cell.ay)),
            (v, *BOUNDS[2:], NOMINAL[1], (cell.bx, cell.by)),
        ):
            if low + 1e-9 < value < high - 1e-9:
                free.append(value - nominal)
                columns.append([weight * x for x in side])
    A, d = np.array(columns), np.array(free)
    if len(free) > 2:
        multiplier = np.linalg.lstsq(A, d, rcond=None)[0]
        np.testing.assert_allclose(A @ multiplier, d, atol=1e-7)


@given(st.integers(0, 10**6), st.floats(0.0, 0.9), st.floats(-300.0, 300.0))
def test_the_solution_does_not_depend_on_the_start(seed, reach, start):
    program = draw(seed, reach)
    one, other = solved(*program), solved(*program, (start, -start))
    assert one[0]
    assert other[0]
    np.testing.assert_allclose(other[3], one[3], atol=1e-8)


def test_the_solution_is_found_at_once_from_its_dual():
    program = draw(5, 0.7)
    assert solved(*program, solved(*program)[1])[2] == 1


@given(st.integers(0, 10**6), st.floats(-3.1, 3.1), st.floats(1.001, 5.0))
def test_an_infeasible_program_is_detected(seed, direction, beyond):
    cells, weights, _ = draw(seed, 0.0)
    towards = np.array([np.cos(direction), np.sin(direction)])
    middle, reach = np.zeros(2), 0.0
    for cell in cells:
        middle += cell.weight * np.array([cell.x, cell.y])
        along = abs(np.dot([cell.ax, cell.ay], towards)) * BOUNDS[1]
        reach += cell.weight * (along + abs(np.dot([cell.bx, cell.by], towards)) * BOUNDS[3])
    goal = tuple((middle + beyond * reach * towards).tolist())
    assert not solved(cells, weights, goal)[0]


def test_the_rate_narrows_the_box_about_the_zmp_or_the_nearest_edge():
    cell = np.zeros(1, CELL)[0]
    set_box(cell, (0.0, 0.0), 0.0, START)
    limit_cell(cell, 0.03, -0.01, 0.015)
    box = [cell[name] for name in ("low_u", "high_u", "low_v", "high_v")]
    assert box == pytest.approx([0.015, 0.04, -0.02, 0.005])
    set_box(cell, (0.1, 0.2), np.pi / 2, START)
    limit_cell(cell, 0.1, 0.3, 0.015)  # 0.1 m ahead, the cell ends at 0.04 m
    box = [cell[name] for name in ("low_u", "high_u", "low_v", "high_v")]
    assert box == pytest.approx([0.025, 0.04, -0.015, 0.015])


@given(st.floats(-0.1, 0.1), st.floats(-0.12, -0.07), st.floats(-0.6, 0.6), st.floats(-0.6, 0.6))
def test_a_cell_of_two_feet_has_two_edges_each_in_one_sole(x, y, yaw, other_yaw):
    ramp, cell = np.zeros(1, RAMP)[0], np.zeros(1, CELL)[0]
    put(ramp.unloading, Foothold(True, 0.0, 0.0, yaw))
    put(ramp.loading, Foothold(False, x, y, other_yaw))
    put_between(ramp, 0.0, Sole(0.01, 0.05, 0.03), cell)
    for v, foot in ((cell.low_v, ramp.unloading), (cell.high_v, ramp.loading)):
        c, s = np.cos(foot.yaw), np.sin(foot.yaw)
        for u in (cell.low_u, cell.high_u):
            dx = cell.x + u * cell.ax + v * cell.bx - foot.x
            dy = cell.y + u * cell.ay + v * cell.by - foot.y
            assert abs(c * dx + s * dy - 0.01) <= 0.05 + 1e-9
            assert abs(c * dy - s * dx) <= 0.03 + 1e-9


def walk_on(rng, *, double, steps):
    """A walk on drawn feet from somewhere in a double or a single support on."""
    feet, turn = [], 0.0
    for k in range(steps + 2):
        turn += rng.uniform(-0.2, 0.2)
        place = (0.06 * k + rng.uniform(-0.01, 0.01), 0.042 * (-1.0) ** k)
        feet.append(Foothold(k % 2 == 0, *place, turn))
    under = [(f.x + 0.01 * np.cos(f.yaw), f.y + 0.01 * np.sin(f.yaw)) for f in feet]
    ramps, count = np.zeros(12, RAMP), 0
    if double:
        middle = tuple((np.add(under[0], under[1]) / 2).tolist())
        set_ramp(ramps[0], int(rng.integers(1, 60)), middle, under[1], feet[0], feet[1])
        count = 1
    set_ramp(ramps[count], int(rng.integers(1, 58)), under[1], under[1], feet[1], feet[1])
    for k in range(1, steps):
        one, other = feet[k], feet[k + 1]
        set_ramp(ramps[count + 1], 14, under[k], under[k + 1], one, other)
        set_ramp(ramps[count + 2], 58, under[k + 1], under[k + 1], other, other)
        count += 2
    return ramps[: count + 1]


def problem(model, seed):
    """Reference, and a pendulum near to it."""
    rng = np.random.default_rng(seed)
    ramps = walk_on(rng, double=bool(rng.integers(2)), steps=int(rng.integers(1, 5)))
    x, y = dcm_reference(ramps, model.robot)
    off, w = rng.uniform(-0.006, 0.006, 4), float(model.robot.omega)
    p = np.zeros(1, PENDULUM)[0]
    p.x, p.y = x - 0.02 + off[0], y + 0.01 + off[1]
    p.vx, p.vy = w * (0.02 + off[2]), w * (-0.01 + off[3])
    p.zmp_x, p.zmp_y = ramps[0].ax + 0.1 * off[0], ramps[0].ay + 0.1 * off[1]
    return ramps, p


def planned(model, ramps, pendulum):
    program = lay_out(ramps, pendulum, SOLE, model.robot, REACH)
    feasible, _, _ = solve(program.cells, program.weights, program.dcm, START, program.knots)
    return feasible, program.knots


@given(st.integers(0, 10**6))
def test_along_the_knots_the_dcm_comes_to_the_reference_and_the_zmp_stays_in_the_soles(model, seed):
    ramps, p = problem(model, seed)
    feasible, knots = planned(model, ramps, p)
    if not feasible:
        return
    w = float(model.robot.omega)
    dcm, now = np.array(dcm_of(p, model.robot)), np.array([p.zmp_x, p.zmp_y])
    ends, time = np.cumsum(ramps["ticks"]), 0.0
    for ticks, *place in knots.tolist():
        after, h = np.array(place), ticks * CONTROL_PERIOD
        slope = (after - now) / h
        dcm = after + slope / w + np.exp(w * h) * (dcm - now - slope / w)
        now, time = after, time + ticks
        index = int(np.searchsorted(ends, time))
        if index < len(ramps) and is_single(ramps[index]):
            foot = foothold(ramps[index].unloading)
            c, s = np.cos(foot.yaw), np.sin(foot.yaw)
            dx, dy = after - (foot.x, foot.y)
            assert abs(c * dx + s * dy - SOLE.centre) <= SOLE.length + 1e-12
            assert abs(c * dy - s * dx) <= SOLE.width + 1e-12
    done = int(np.searchsorted(ends, time, side="right"))
    goal = now
    if done < len(ramps):
        goal = dcm_reference(ramps[done:], model.robot)
    np.testing.assert_allclose(dcm, goal, atol=1e-6)  # a walk of a second multiplies by 1000


def test_most_of_those_programs_have_a_solution(model):
    assert sum(planned(model, *problem(model, seed))[0] for seed in range(100)) > 50


def straight(stride, left):
    """Reference of a straight walk with `left` ticks of the first single support to go."""
    feet = [Foothold(k % 2 == 0, k * stride, 0.042 * (-1.0) ** k, 0.0) for k in range(6)]
    ramps = np.zeros(11, RAMP)
    for k, foot in enumerate(feet):
        place = (foot.x + 0.01, foot.y)
        set_ramp(ramps[2 * k], left if k == 0 else 54, place, place, foot, foot)
        if k > 0:
            before = (feet[k - 1].x + 0.01, feet[k - 1].y)
            set_ramp(ramps[2 * k - 1], 14, before, place, feet[k - 1], foot)
    return ramps


class Robust:
    """Generator on a straight walk, from its DCM on."""

    def __init__(self, model, stride=0.05):
        self.model, self.plans = model, np.zeros(4, PLAN)
        self.knots, self.pendulum = np.zeros((4, 200), KNOT), np.zeros(1, PENDULUM)[0]
        x, y = dcm_reference(straight(stride, 54), model.robot)
        p, w = self.pendulum, float(model.robot.omega)
        p.x, p.y, p.zmp_x, p.zmp_y = -0.02, 0.042, 0.01, 0.042
        p.vx, p.vy = w * (x + 0.02), w * (y - 0.042)
        foot = Foothold(True, 0.0, 0.042, 0.0)
        self.region = support_region(model.robot.support, foot, foot, 0.005)

    def admits(self, stride, left):
        robot, ramps = self.model.robot, straight(stride, left)
        rest = (self.pendulum, ramps, robot.pattern.plan_margin, robot)
        return admits_knots(self.plans, self.knots, *rest)

    def tick(self, stride, left):
        """Whether the reference is admitted, and the ZMP."""
        accepted, ramps = self.admits(stride, left), straight(stride, left)
        rest = (self.pendulum, ramps, self.region, self.model.robot)
        advance_knots(self.plans, self.knots, accepted, *rest)
        zmp = (float(self.pendulum.zmp_x), float(self.pendulum.zmp_y))
        assert clip(self.region, *zmp) == pytest.approx(zmp, abs=1e-12)
        return accepted, *zmp


def test_on_the_reference_the_plan_is_the_reference(model):
    generator = Robust(model)
    path = np.array([generator.tick(0.05, 54 - k)[1:] for k in range(53)])
    np.testing.assert_allclose(path, np.tile([0.01, 0.042], (53, 1)), atol=1e-9)


@pytest.mark.parametrize("tick", [0, 20, 35])
def test_a_new_landing_is_walked_to_within_the_rate_of_the_zmp(model, tick):
    generator = Robust(model)
    path = [generator.tick(0.05 if k < tick else 0.07, 54 - k) for k in range(54)]
    assert all(row[0] for row in path)
    rates = np.abs(np.diff([row[1:] for row in path], axis=0)) / CONTROL_PERIOD
    assert rates.max() < model.robot.pattern.zmp_rate + 1e-9


def test_an_infeasible_landing_is_rejected_and_the_last_plan_remains_feasible(model):
    generator = Robust(model)
    generator.pendulum.vx += 0.02
    for k in range(40):
        generator.tick(0.05, 54 - k)
    assert not generator.admits(0.15, 14)
    live = generator.plans[LIVE].zmp
    assert remains_feasible(live, straight(0.05, 14))
    assert not remains_feasible(live, straight(0.15, 14))


def test_after_a_push_no_plan_is_feasible_and_the_zmp_stays_in_the_sole(model):
    generator = Robust(model)
    generator.pendulum.vx += 1.5
    assert not generator.tick(0.05, 54)[0]
    assert not generator.plans[LIVE].zmp.exists
    for k in range(1, 30):
        generator.tick(0.05, 54 - k)


def test_a_plan_is_followed_knot_by_knot_and_the_pendulum_obeys(model):
    generator, w2 = Robust(model), float(model.robot.omega) ** 2
    for k in range(10):
        before = generator.pendulum.copy()
        generator.tick(0.065, 54 - k)
        after = generator.pendulum
        for axis in ("x", "y"):
            p, q = before["zmp_" + axis], after["zmp_" + axis]
            rate = (q - p) / CONTROL_PERIOD
            solution = solve_ivp(
                lambda t, s, p=p, rate=rate: [s[1], w2 * (s[0] - p - rate * t)],
                (0.0, CONTROL_PERIOD),
                [before[axis], before["v" + axis]],
                rtol=1e-11,
                atol=1e-13,
            )
            assert solution.y[:, -1] == pytest.approx([after[axis], after["v" + axis]], abs=1e-11)
