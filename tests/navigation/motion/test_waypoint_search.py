from dataclasses import replace

import numpy as np
import pytest

from navigation.motion.waypoint_search import search_waypoint, shortest_path
from navigation.parameters.motion import WaypointSearchParameters

P = WaypointSearchParameters()
START, GOAL = np.zeros(2), np.array([2.0, 0.0])
WALL = np.array([[1.0, y] for y in np.arange(-0.6, 1.01, 0.2)])
RADII = np.full(len(WALL), 0.25)


def test_a_free_path_needs_no_waypoint():
    assert search_waypoint(START, GOAL, np.zeros((0, 2)), np.zeros(0), P) is GOAL
    aside = np.array([[1.0, 0.5]])
    assert search_waypoint(START, GOAL, aside, np.array([0.3]), P) is GOAL


def test_the_path_around_a_wall_is_the_shorter_one_and_free():
    path = shortest_path(START, GOAL, WALL, RADII, P)
    gaps = np.hypot(*(path[:-1, None] - WALL).transpose(2, 0, 1))
    assert np.all(gaps >= 0.25)
    assert path[-1] == pytest.approx(GOAL)
    assert path[:, 1].min() < -0.8
    assert np.hypot(*np.diff(path, axis=0).T).max() < 2.5 * P.cell


def test_the_waypoint_is_visible_in_reach_and_leads_around():
    point = search_waypoint(START, GOAL, WALL, RADII, P)
    assert np.hypot(*point) <= P.reach
    assert point[1] < -0.3
    position = START
    for _ in range(60):
        point = search_waypoint(position, GOAL, WALL, RADII, P)
        step = point - position
        position = position + 0.1 * step / max(0.1, np.hypot(*step))
        assert np.hypot(*(position - WALL).T).min() > 0.25 - 1e-9
    assert position == pytest.approx(GOAL, abs=0.01)


def test_a_blocked_destination_in_the_robot_s_cell_leaves_the_task():
    p, target = replace(P, around=0.95), np.array([0.01, 0.0])
    blocking, radius = np.array([[0.06, 0.0]]), np.array([0.055])
    assert shortest_path(START, target, blocking, radius, p).shape == (0, 2)
    assert search_waypoint(START, target, blocking, radius, p) is target


def test_a_mirrored_wall_has_a_path_of_the_same_length():
    one = shortest_path(START, GOAL, WALL, RADII, P)
    other = shortest_path(START, GOAL, WALL * [1, -1], RADII, P)
    lengths = [np.hypot(*np.diff(w, axis=0).T).sum() for w in (one, other)]
    assert lengths[0] == pytest.approx(lengths[1], abs=2 * P.cell)


def test_without_a_path_the_task_stays():
    ring = np.arange(24) * np.pi / 12
    around = GOAL + 0.6 * np.stack([np.cos(ring), np.sin(ring)], axis=1)
    assert search_waypoint(START, GOAL, around, np.full(24, 0.2), P) is GOAL
