"""The quadratic program of the knots against its own optimality conditions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.zmp_fit import Cell, ZmpFit, limited, sides

NOMINAL = (0.005, -0.003)
BOUNDS = (-0.04, 0.04, -0.02, 0.02)
START = (0.0, 0.0)


def draw(seed, reach):
    """Cells on feet of all directions, and a DCM `reach` of the way to the farthest."""
    rng = np.random.default_rng(seed)
    cells, farthest, k = [], np.zeros(2), 0
    for knots in (1, 4, 2, 1):
        angle = rng.uniform(-0.5, 0.5) if knots < 4 else 0.2
        c, s = float(np.cos(angle)), float(np.sin(angle))
        cx, cy = rng.uniform(-0.1, 0.1, 2).tolist()
        cell = Cell((cx, cy), ((c, s), (-s, c)), (*NOMINAL, *BOUNDS), knots)
        cell.weigh([float(0.3 * 0.6**j) for j in range(k, k + knots)])
        k += knots
        corner = np.array([rng.choice(BOUNDS[:2]), rng.choice(BOUNDS[2:])]) * reach
        farthest += cell.total * (np.array([cx, cy]) + np.array([[c, -s], [s, c]]) @ corner)
        cells.append(cell)
    return cells, farthest.tolist()


def points_of(cells, fit):
    """Of every knot: weight, direction, point in the frame of its cell (n, 5), and Σ w p."""
    rows, total, points = [], np.zeros(2), iter(fit.points())
    for cell in cells:
        c, s = cell.axes[0]
        for weight in cell.weights:
            point = np.array(next(points))
            dx, dy = point - cell.centre
            rows.append([weight, c, s, c * dx + s * dy, c * dy - s * dx])
            total += weight * point
    return rows, total


@given(st.integers(0, 10**6), st.floats(0.0, 0.99))
def test_what_can_be_brought_about_is(seed, reach):
    cells, dcm = draw(seed, reach)
    fit = ZmpFit(cells, *dcm)
    assert fit.solve(START)
    rows, total = points_of(cells, fit)
    np.testing.assert_allclose(total, dcm, atol=2e-10)
    for *_, u, v in rows:
        assert BOUNDS[0] - 1e-12 <= u <= BOUNDS[1] + 1e-12
        assert BOUNDS[2] - 1e-12 <= v <= BOUNDS[3] + 1e-12


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.floats(0.0, 0.9))
def test_no_neighbour_that_does_the_same_is_nearer(seed, reach):
    """The move is orthogonal to every direction that keeps DCM and boxes."""
    cells, dcm = draw(seed, reach)
    fit = ZmpFit(cells, *dcm)
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
    one, other = ZmpFit(cells, *dcm), ZmpFit(cells, *dcm)
    assert one.solve(START)
    assert other.solve((start, -start))
    np.testing.assert_allclose(other.points(), one.points(), atol=1e-8)


def test_the_solution_is_found_at_once_from_its_own_dual():
    cells, dcm = draw(5, 0.7)
    fit, again = ZmpFit(cells, *dcm), ZmpFit(cells, *dcm)
    fit.solve(START)
    again.solve(fit.dual)
    assert again.evaluations == 1


@given(st.integers(0, 10**6), st.floats(-3.1, 3.1), st.floats(1.001, 5.0))
def test_what_is_out_of_reach_is_turned_down(seed, direction, beyond):
    cells, _ = draw(seed, 0.0)
    towards = np.array([np.cos(direction), np.sin(direction)])
    middle, reach = np.zeros(2), 0.0
    for cell in cells:
        c, s = cell.axes[0]
        middle += cell.total * np.array(cell.centre)
        along, across = np.array([[c, s], [-s, c]]) @ towards
        reach += cell.total * (abs(along) * BOUNDS[1] + abs(across) * BOUNDS[3])
    fit = ZmpFit(cells, *(middle + beyond * reach * towards).tolist())
    assert not fit.solve(START)


def test_the_rate_narrows_the_box_about_the_zmp():
    cell = Cell((0.0, 0.0), ((1.0, 0.0), (0.0, 1.0)), (0.0, 0.0, *BOUNDS), 3)
    narrow = limited(cell, 0.03, -0.01, 0.015)
    assert narrow.knots == 1
    assert narrow.box[2:4] == pytest.approx((0.015, 0.04))
    assert narrow.box[4:] == pytest.approx((-0.02, 0.005))


@given(st.floats(-3.0, 3.0), st.floats(0.3, 2.8), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_the_coordinates_along_two_directions_lead_back(angle, between, x, y):
    a = (float(np.cos(angle)), float(np.sin(angle)))
    b = (2.0 * float(np.cos(angle + between)), 2.0 * float(np.sin(angle + between)))
    u, v = sides((a, b), x, y)
    assert (a[0] * u + b[0] * v, a[1] * u + b[1] * v) == pytest.approx((x, y), abs=1e-9)


def test_a_zmp_outside_its_cell_counts_as_on_its_edge():
    turned = Cell((0.1, 0.2), ((0.0, 1.0), (-1.0, 0.0)), (0.0, 0.0, *BOUNDS), 3)
    narrow = limited(turned, 0.1, 0.3, 0.015)  # 0.1 m ahead, the cell ends at 0.04 m
    assert narrow.box == pytest.approx((0.0, 0.0, 0.025, 0.04, -0.015, 0.015))
