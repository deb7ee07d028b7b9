"""Sole, support region and support polygon against the convex hull of the soles."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from walking.model import Sole
from walking.plan.footsteps import Foothold
from walking.plan.support import clip, depth, load_fraction, polygon, support_region

MARGIN = 0.005
RIGHT = Foothold(False, 0.0, -0.042, 0.0)
coordinates = st.floats(-0.3, 0.3)


def corners(sole, foot, margin):
    u = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
    u = u * [sole.half_length - margin, sole.half_width - margin] + [sole.centre, 0.0]
    c, s = np.cos(foot.yaw), np.sin(foot.yaw)
    return u @ np.array([[c, s], [-s, c]]) + [foot.x, foot.y]


def outside(sole, point, feet, margin):
    hull = ConvexHull(np.concatenate([corners(sole, foot, margin) for foot in feet]))
    return (hull.equations[:, :2] @ point + hull.equations[:, 2]).max()


@pytest.fixture(scope="module")
def sole(model):
    return model.robot.support


@given(coordinates, coordinates, st.floats(-0.1, 0.1), st.floats(-0.7, 0.7))
def test_clipped_points_are_inside_the_hull_of_both_soles(sole, x, y, ahead, yaw):
    left = Foothold(True, ahead, 0.06, yaw)
    region = support_region(sole, RIGHT, left, MARGIN)
    assert outside(sole, clip(region, x, y), (RIGHT, left), MARGIN) < 1e-9


@given(coordinates, coordinates, st.floats(-3.0, 3.0))
def test_clipped_points_are_inside_a_single_sole_and_clipped_once(sole, x, y, yaw):
    foot = Foothold(True, 0.2, -0.1, yaw)
    region = support_region(sole, foot, foot, MARGIN)
    once = clip(region, x, y)
    assert outside(sole, once, (foot,), MARGIN) < 1e-9
    assert clip(region, *once) == pytest.approx(once, abs=1e-12)


def test_the_load_fraction_runs_from_one_foot_to_the_other(sole):
    left, middle = Foothold(True, 0.0, 0.042, 0.0), float(sole.centre)
    region = support_region(sole, RIGHT, left, MARGIN)
    fractions = [load_fraction(region, middle, y) for y in (-0.042, 0.0, 0.2)]
    assert fractions == pytest.approx([0.0, 0.5, 1.0])


@given(coordinates, coordinates, st.floats(-0.1, 0.1), st.floats(-0.7, 0.7))
def test_the_depth_in_the_polygon_agrees_with_the_hull(sole, x, y, ahead, yaw):
    left = Foothold(True, ahead, 0.08, yaw)
    found = depth(polygon(sole, RIGHT, left, False), x, y)
    assert found == pytest.approx(-outside(sole, (x, y), (RIGHT, left), 0.0), abs=1e-9)


@given(st.floats(-0.1, 0.1), st.integers(-15, -6), st.sampled_from((-1.0, 1.0)))
def test_soles_that_are_almost_parallel_lose_no_corner(sole, ahead, exponent, sign):
    left = Foothold(True, ahead, 0.08, sign * 10.0**exponent)
    hull = polygon(sole, RIGHT, left, False)
    for x, y in np.random.default_rng(0).uniform(-0.2, 0.2, (20, 2)).tolist():
        expected = -outside(sole, (x, y), (RIGHT, left), 0.0)
        assert depth(hull, x, y) == pytest.approx(expected, abs=1e-7)


SOLE = Sole(0.01, 0.11, 0.05)


@pytest.mark.parametrize("forward", [0.03, 0.08, 0.11, 0.115, 0.2])
@pytest.mark.parametrize("side", [0.02, 0.05, 0.1])
def test_weak_ankles_press_the_part_within_their_torque(forward, side):
    part = SOLE.pressed(forward, side)
    front, back = part.centre + part.half_length, part.centre - part.half_length
    assert front == pytest.approx(min(0.12, forward))
    assert back == pytest.approx(max(-0.10, -forward))
    assert part.half_width == min(0.05, side)
