import numpy as np
import pytest

from navigation.belief.local_map import LocalMap
from navigation.belief.visibility import Viewpoint
from navigation.parameters.belief import LocalMapParameters

NONE = (np.empty((0, 2)), np.empty(0))
P = LocalMapParameters()
CELL, CORNER, SIDE = 0.1, (-7, 4), 12


def look(grid, time, camera, pose=(0.0, 0.0, 0.0), obstacles=NONE):
    viewpoint = Viewpoint.of(camera, np.array(pose, float), P.range)
    grid.update(time, viewpoint, (pose[0], pose[1]), *obstacles)


def occupancy(grid):
    """Probability that each cell is occupied."""
    _, _, log_odds = grid.contents()
    return 1.0 / (1.0 + np.exp(-log_odds))


def occupancy_at(grid, points):
    """The same under points of the map."""
    corner = grid.contents()[0][:2]
    columns, rows = (np.floor(np.asarray(points) / grid.cell) - corner).astype(int).T
    return occupancy(grid)[rows, columns]


@pytest.mark.parametrize("rate", [10, 15, 16.667, 30])
def test_confidence_is_085_after_5_s_at_any_frame_rate(view, rate):
    grid = LocalMap(P, (0.05, 0.05), 0.0)
    point = np.array([[1.0, 0.0]])
    look(grid, 0.0, view(pan=0.0))
    frames = 0
    while grid.confidence_at(point)[0] >= 0.85:
        frames += 1
        look(grid, frames / rate, view(pan=1.57))
    assert abs(frames / rate - 5.0) <= 1.0 / rate + 1e-9


def test_confidence_starts_at_zero_rises_in_view_and_never_goes_negative(view):
    grid = LocalMap(P, (0.0, 0.0), 0.0)
    point = np.array([[1.0, 0.1]])
    assert grid.confidence_at(point)[0] == 0.0
    assert grid.age_at(point)[0] == np.inf
    look(grid, 1.0, view(pan=0.0))
    assert grid.confidence_at(point)[0] == 1.0
    assert grid.age_at(point)[0] == 0.0
    look(grid, 100.0, view(pan=1.57))
    assert grid.confidence_at(point)[0] == 0.0
    assert grid.confidence.min() == 0.0


def test_outside_the_map_is_confident_and_unknown(view):
    grid = LocalMap(P, (0.0, 0.0), 0.0)
    look(grid, 1.0, view())
    far = np.array([[50.0, 0.0], [0.0, -50.0]])
    assert grid.confidence_at(far).tolist() == [1.0, 1.0]
    assert grid.age_at(far).tolist() == [0.0, 0.0]
    assert not grid.free_at(far).any()


def test_a_scrolled_map_equals_a_fixed_one(view):
    """The map that rolls with the robot, against a large one that never moves."""
    rng = np.random.default_rng(5)
    rolling = LocalMap(LocalMapParameters(), (0.0, 0.0), 0.0)
    fixed = LocalMap(LocalMapParameters(size=20.0), (0.0, 0.0), 0.0)
    obstacles, radii = rng.uniform(0, 4, (12, 2)), rng.uniform(0.05, 0.12, 12)
    for k in range(1, 60):
        pose = np.array([0.06 * k, 0.04 * k, 0.6 + 0.5 * np.sin(0.3 * k)])
        viewpoint = Viewpoint.of(view(pan=np.sin(0.7 * k)), pose, 2.5)
        near = np.hypot(*(obstacles - pose[:2]).T) < 2.0
        rolling.update(0.06 * k, viewpoint, tuple(pose[:2]), obstacles[near], radii[near])
        fixed.update(0.06 * k, viewpoint, (0.0, 0.0), obstacles[near], radii[near])
    x, y = rolling.origin
    steps = (np.arange(len(rolling.age)) + 0.5) * rolling.cell
    points = np.stack(np.meshgrid(x + steps, y + steps), axis=-1).reshape(-1, 2)
    assert np.array_equal(rolling.age_at(points), fixed.age_at(points))
    assert np.array_equal(occupancy_at(rolling, points), occupancy_at(fixed, points))
    assert rolling.origin != LocalMap(LocalMapParameters(), (0.0, 0.0), 0.0).origin
    assert np.isfinite(rolling.age).mean() > 0.1


@pytest.mark.parametrize("rate", [10, 30])
def test_occupancy_does_not_depend_on_the_frame_rate(view, rate):
    viewpoint = Viewpoint.of(view(), np.zeros(3), 2.5)
    position = np.array([[1.0, 0.0]])
    grid = LocalMap(LocalMapParameters(), (0.0, 0.0), 0.0)
    for k in range(1, rate // 10 + 1):
        grid.update(k / rate, viewpoint, (0.0, 0.0), position, np.array([0.08]))
    odds = 15.0 * 0.1
    assert occupancy_at(grid, position) == pytest.approx(1 / (1 + np.exp(-odds)))
    assert occupancy_at(grid, [[1.5, 0.5]]) == pytest.approx(1 / (1 + np.exp(6.0 * 0.1)))


def test_free_is_where_the_cell_and_its_four_neighbours_were_seen_empty(view):
    grid = LocalMap(P, (0.0, 0.0), 0.0)
    obstacle = (np.array([[1.0, 0.0]]), np.array([0.1]))
    for k in range(5):
        look(grid, 0.1 * k, view(pan=0.0), obstacles=obstacle)
    n = len(grid.age)
    empty = np.pad(occupancy(grid) < 0.5, 1)
    wanted = empty[1:-1, 1:-1] & empty[:-2, 1:-1] & empty[2:, 1:-1]
    wanted &= empty[1:-1, :-2] & empty[1:-1, 2:]
    centres = grid.origin + (np.stack(np.meshgrid(np.arange(n), np.arange(n)), -1) + 0.5) * P.cell
    assert np.array_equal(grid.free_at(centres.reshape(-1, 2)), wanted.ravel())
    assert 0 < wanted.sum() < (occupancy(grid) < 0.5).sum()
    assert not grid.free_at([[50.0, 0.0]])[0]


def test_evidence_of_one_look_and_of_all_is_bounded(view):
    viewpoint = Viewpoint.of(view(), np.zeros(3), 2.5)
    position = np.array([[1.0, 0.0]])
    grid = LocalMap(P, (0.0, 0.0), 0.0)
    grid.update(100.0, viewpoint, (0.0, 0.0), position, np.array([0.08]))
    odds = min(P.max_look_time * P.occupied_rate, P.max_log_odds)
    assert occupancy_at(grid, position) == pytest.approx(1 / (1 + np.exp(-odds)))
    for k in range(200):
        grid.update(101.0 + k, viewpoint, (0.0, 0.0), position, np.array([0.08]))
    assert occupancy_at(grid, position) == pytest.approx(1 / (1 + np.exp(-P.max_log_odds)))
    assert occupancy_at(grid, [[1.5, 0.5]]) == pytest.approx(1 / (1 + np.exp(P.max_log_odds)))


@pytest.fixture
def grid():
    rng = np.random.default_rng(3)
    low = np.multiply(CORNER, CELL)
    points = rng.uniform(low - 3 * CELL, low + (SIDE + 3) * CELL, (400, 2))
    strange = np.array([[np.nan, 0.5], [np.inf, 0.5], [0.0, -1e300]])
    return np.concatenate([points, strange]), rng.uniform(-3.0, 1.0, (SIDE, SIDE))
