"""The quadratic program of the knots against its own optimality conditions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.robot_model import Sole
from walking.state import Footstep
from walking.support import support_region
from walking.zmp_fit import Knot, ZmpFit, knot_at, limit_rate

SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
BOX = (-0.04, 0.04, -0.02, 0.02)


def draw(seed, reach):
    """Knots on feet of all directions, and a DCM `reach` of the way to the farthest."""
    rng = np.random.default_rng(seed)
    knots, farthest = [], np.zeros(2)
    for k in range(8):
        angle = rng.uniform(-0.5, 0.5) if k > 4 else 0.2
        c, s = float(np.cos(angle)), float(np.sin(angle))
        cx, cy = rng.uniform(-0.1, 0.1, 2).tolist()
        knots.append(Knot(9, cx, cy, c, s, 0.005, -0.003, *BOX, weight=float(0.3 * 0.6**k)))
        corner = np.array([rng.choice(BOX[:2]), rng.choice(BOX[2:])]) * reach
        farthest += knots[-1].weight * (np.array([cx, cy]) + np.array([[c, -s], [s, c]]) @ corner)
    return knots, farthest.tolist()


def brought_about(knots):
    total = np.zeros(2)
    for k in knots:
        total += k.weight * np.array([k.cx + k.c * k.u - k.s * k.v, k.cy + k.s * k.u + k.c * k.v])
    return total


@given(st.integers(0, 10**6), st.floats(0.0, 0.99))
def test_what_can_be_brought_about_is(seed, reach):
    knots, dcm = draw(seed, reach)
    assert ZmpFit(knots, *dcm).solve() == (0.0, 0.0)
    np.testing.assert_allclose(brought_about(knots), dcm, atol=2e-10)
    for k in knots:
        assert BOX[0] <= k.u <= BOX[1]
        assert BOX[2] <= k.v <= BOX[3]


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.floats(0.0, 0.9))
def test_no_neighbour_that_does_the_same_is_nearer(seed, reach):
    """The move is orthogonal to every direction that keeps DCM and boxes."""
    knots, dcm = draw(seed, reach)
    ZmpFit(knots, *dcm).solve()
    free, rows = [], []
    for k in knots:
        for value, low, high, nominal, column in (
            (k.u, *BOX[:2], 0.005, (k.c, k.s)),
            (k.v, *BOX[2:], -0.003, (-k.s, k.c)),
        ):
            if low + 1e-9 < value < high - 1e-9:
                free.append(value - nominal)
                rows.append([k.weight * c for c in column])
    A, d = np.array(rows), np.array(free)
    if len(free) > 2:
        multiplier = np.linalg.lstsq(A, d, rcond=None)[0]
        np.testing.assert_allclose(A @ multiplier, d, atol=1e-7)


@pytest.mark.parametrize("direction", [0.0, 0.7, 2.0])
def test_what_is_out_of_reach_is_missed_by_what_is_said(direction):
    knots, _ = draw(3, 0.0)
    far = 5.0 * np.array([np.cos(direction), np.sin(direction)])
    missed = ZmpFit(knots, *far.tolist()).solve()
    np.testing.assert_allclose(brought_about(knots) + missed, far, atol=1e-9)
    assert np.hypot(*missed) > 1.0


def test_a_knot_of_a_double_support_lies_between_the_soles():
    region = support_region(SOLE, Footstep(True, 0, 0.05, 0.1), Footstep(False, 0, -0.05, 0), 0.005)
    knot = knot_at(5, region, 0.01, 0.0, on_second=False)
    assert -0.04 < knot.cy < 0.04
    alone = knot_at(5, region, 0.01, -0.04, on_second=True)
    assert (alone.cx, alone.cy, alone.c, alone.s) == (0.01, -0.05, 1.0, 0.0)


def test_the_rate_narrows_the_box_about_the_zmp():
    knot = Knot(2, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, *BOX)
    limit_rate(knot, 0.03, -0.01, 0.015)
    assert (knot.low_u, knot.high_u) == pytest.approx((0.015, 0.04))
    assert (knot.low_v, knot.high_v) == pytest.approx((-0.02, 0.005))
