"""The support region is the hull of the soles."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.pattern.support import SupportPolygon, edges, support_polygon, support_region
from walking.pattern.support_kernel import depth

SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
MARGIN = 0.005
RIGHT = Foothold(False, 0.0, -0.042, 0.0)
coordinates = st.floats(-0.3, 0.3)


def corners(foot, margin):
    u = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
    u = u * [SOLE.half_length - margin, SOLE.half_width - margin] + [SOLE.centre, 0.0]
    c, s = np.cos(foot.yaw), np.sin(foot.yaw)
    return u @ np.array([[c, s], [-s, c]]) + [foot.x, foot.y]


def outside(point, feet, margin):
    hull = ConvexHull(np.concatenate([corners(foot, margin) for foot in feet]))
    return (hull.equations[:, :2] @ point + hull.equations[:, 2]).max()


@given(coordinates, coordinates, st.floats(-0.1, 0.1), st.floats(-0.7, 0.7))
def test_clipped_points_are_inside_the_hull_of_both_soles(x, y, ahead, yaw):
    left = Foothold(True, ahead, 0.06, yaw)
    region = support_region(SOLE, RIGHT, left, MARGIN)
    assert outside(region.clip(x, y), (RIGHT, left), MARGIN) < 1e-9


@given(coordinates, coordinates, st.floats(-3.0, 3.0))
def test_clipped_points_are_inside_a_single_sole(x, y, yaw):
    foot = Foothold(True, 0.2, -0.1, yaw)
    region = support_region(SOLE, foot, foot, MARGIN)
    assert outside(region.clip(x, y), (foot,), MARGIN) < 1e-9


@given(coordinates, coordinates)
def test_clipping_twice_changes_nothing(x, y):
    region = support_region(SOLE, RIGHT, RIGHT, MARGIN)
    once = region.clip(x, y)
    assert region.clip(*once) == pytest.approx(once, abs=1e-12)


def test_load_fraction_runs_from_one_foot_to_the_other():
    left = Foothold(True, 0.0, 0.042, 0.0)
    region = support_region(SOLE, RIGHT, left, MARGIN)
    assert region.load_fraction(0.01, -0.042) == pytest.approx(0.0)
    assert region.load_fraction(0.01, 0.0) == pytest.approx(0.5)
    assert region.load_fraction(0.01, 0.2) == 1.0


@given(coordinates, coordinates, st.floats(-0.1, 0.1), st.floats(-0.7, 0.7))
def test_depth_in_the_polygon_agrees_with_the_hull(x, y, ahead, yaw):
    left = Foothold(True, ahead, 0.08, yaw)
    sides = edges(support_polygon(SOLE, RIGHT, left))
    assert depth(sides, x, y) == pytest.approx(-outside((x, y), (RIGHT, left), 0.0), abs=1e-9)


@given(st.floats(-0.1, 0.1), st.integers(-15, -6), st.sampled_from((-1.0, 1.0)))
def test_soles_that_are_almost_parallel_lose_no_corner(ahead, exponent, sign):
    left = Foothold(True, ahead, 0.08, sign * 10.0**exponent)
    sides = edges(support_polygon(SOLE, RIGHT, left))
    for x, y in np.random.default_rng(0).uniform(-0.2, 0.2, (20, 2)):
        expected = -outside((x, y), (RIGHT, left), 0.0)
        assert depth(sides, x, y) == pytest.approx(expected, abs=1e-7)


def test_the_polygon_of_one_foot_is_its_sole():
    foot = Foothold(True, 0.2, -0.1, 0.4)
    polygon = support_polygon(SOLE, foot, foot)
    assert len(polygon) == 4
    centre = np.mean(polygon, axis=0)
    assert depth(edges(polygon), *centre.tolist()) == pytest.approx(SOLE.half_width)
    assert centre == pytest.approx([0.2 + 0.01 * np.cos(0.4), -0.1 + 0.01 * np.sin(0.4)])


def test_the_support_polygon_follows_its_feet():
    polygon = SupportPolygon(SOLE, (RIGHT, RIGHT))
    left = Foothold(True, 0.0, 0.042, 0.0)
    for feet in ((RIGHT, left), (left, left), (RIGHT, RIGHT)):
        polygon.update(feet)
        assert polygon.depth(0.02, 0.01) == depth(edges(support_polygon(SOLE, *feet)), 0.02, 0.01)
        for margin in (0.004, 0.01):
            np.testing.assert_array_equal(
                polygon.region(margin).row, support_region(SOLE, *feet, margin).row
            )
