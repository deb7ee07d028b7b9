import math
from math import hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navigation.angles import wrap, wrap_array
from navigation.transform import (
    points_to_robot,
    points_to_world,
    pose_from_points,
    propagate,
    to_world,
    velocity_in_world,
)
from tests.navigation.sightings import range_bearing

metres = st.floats(-5.0, 5.0)
headings = st.floats(-3.14, 3.14)


@given(metres, metres, headings, metres, metres)
def test_a_sighting_leads_back_to_the_landmark(x, y, heading, a, b):
    distance, bearing = range_bearing((x, y, heading), (a, b))
    back = to_world((x, y, heading), distance, bearing)
    assert hypot(back[0] - a, back[1] - b) < 1e-9


@given(metres, metres, headings, metres, metres)
def test_points_are_seen_where_sightings_are(x, y, heading, a, b):
    distance, bearing = range_bearing((x, y, heading), (a, b))
    observed = points_to_robot((x, y, heading), np.array([[a, b]]))
    assert np.allclose(
        observed, [[distance * np.cos(bearing), distance * np.sin(bearing)]], atol=1e-9
    )
    assert np.allclose(points_to_world(np.array([x, y, heading]), observed), [[a, b]], atol=1e-9)


@given(metres, metres, headings)
def test_pose_from_points_inverts_the_sightings(x, y, heading):
    landmarks = np.array([[2.0, 1.0], [-1.0, 3.0], [0.5, -2.0]])
    observed = []
    for landmark in landmarks:
        distance, bearing = range_bearing((x, y, heading), tuple(landmark.tolist()))
        observed.append((distance * np.cos(bearing), distance * np.sin(bearing)))
    for count in (2, 3):
        pose = pose_from_points(np.array(observed[:count]), landmarks[:count])
        assert np.allclose(pose[:2], [x, y], atol=1e-8)
        assert abs(wrap(pose[2] - heading)) < 1e-8


@given(metres, metres, headings, metres, metres)
def test_a_velocity_in_the_world_is_how_a_pose_moves(x, y, heading, forward, left):
    pose, dt = np.array([x, y, heading]), 0.5
    there = points_to_world(pose, dt * np.array([[forward, left]]))[0]
    velocity = velocity_in_world(pose, np.array([forward, left, 0.3]))
    assert np.allclose(pose[:2] + dt * velocity, there, atol=1e-9)


@given(metres, metres, headings, metres, metres, headings)
def test_odometry_moves_a_pose_as_it_moved_itself_and_in_two_steps_as_in_one(x, y, a, u, v, b):
    pose, before = np.array([x, y, a]), np.array([u, v, b])
    steps = np.array([[0.3, -0.2, 0.7], [0.1, 0.4, -0.5]])
    middle, after = before + steps
    assert np.allclose(propagate(before, before, after)[0], after)
    halfway, first = propagate(pose, before, middle)
    end, second = propagate(halfway, middle, after)
    whole, derivative = propagate(pose, before, after)
    assert np.allclose(end, whole, atol=1e-9)
    assert np.allclose(second @ first, derivative, atol=1e-9)
    for k in range(3):
        step = 1e-6 * np.eye(3)[k]
        moved = propagate(pose + step, before, after)[0] - whole
        assert np.allclose(moved / 1e-6, derivative[:, k], atol=1e-5)


angles = st.floats(-1e4, 1e4)


@given(angles)
def test_wrap_keeps_the_direction_and_the_interval(a):
    w = wrap(a)
    assert -math.pi < w <= math.pi
    assert math.isclose(math.cos(w), math.cos(a), abs_tol=1e-9)
    assert math.isclose(math.sin(w), math.sin(a), abs_tol=1e-9)


@pytest.mark.parametrize("a", [math.pi, -math.pi, 3 * math.pi, np.nextafter(math.pi, 4.0)])
def test_the_seam_belongs_to_plus_pi(a):
    assert wrap(math.pi) == math.pi
    assert wrap(-math.pi) == math.pi
    assert -math.pi < float(wrap_array(a)) <= math.pi


@given(angles)
def test_wrapping_is_exact(a):
    w = math.remainder(a, 2.0 * math.pi)
    assert wrap(a) == (math.pi if w == -math.pi else w)
