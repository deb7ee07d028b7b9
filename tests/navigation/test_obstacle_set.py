import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.obstacle_set import ObstacleSet, max_deviation, possible_positions


def test_max_deviation_is_that_of_the_eigenvalues_and_ignores_rotation():
    rng = np.random.default_rng(0)
    a = rng.normal(size=(50, 2, 2))
    p = a @ a.transpose(0, 2, 1)
    expected = np.sqrt(np.linalg.eigvalsh(p)[:, -1])
    assert [max_deviation(q) for q in p] == pytest.approx(expected)
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s], [s, c]])
    assert [max_deviation(q) for q in turn @ p @ turn.T] == pytest.approx(expected)


def test_static_tracks_have_no_speed(track):
    o = ObstacleSet.from_tracks(
        [track((1, 0), (0.1, 0), Motion.STATIC), track((1, 1), (0.1, 0), Motion.UNKNOWN)]
    )
    assert o.speed == pytest.approx([0.0, 0.1])
    assert o.static.tolist() == [True, False]
    assert not o.moving.any()


def test_no_tracks_make_an_empty_set():
    o = ObstacleSet.from_tracks([])
    assert len(o) == 0
    assert o.position.shape == (0, 2)


def test_selection_keeps_rows_together(track):
    tracks = [track((i, 2 * i), (0.1 * i, 0.0), id=i) for i in range(4)]
    part = ObstacleSet.from_tracks(tracks).where(np.array([False, True, False, True]))
    assert part.ids.tolist() == [1, 3]
    assert part.position[:, 1] == pytest.approx([2, 6])
    assert part.speed == pytest.approx([0.1, 0.3])


def test_possible_positions_are_those_of_tracks_and_the_particles_of_lost_ones(track):
    cloud = ([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], np.zeros((3, 2)), [0.5, 0.3, 0.2])
    tracks = [track((0.0, 1.0)), track((9.0, 9.0), particles=cloud), track((0.0, 2.0))]
    owner, positions, weights = possible_positions(tracks)
    assert owner.tolist() == [0, 1, 1, 1, 2]
    assert positions.tolist() == [[0, 1], [1, 0], [2, 0], [3, 0], [0, 2]]
    assert np.bincount(owner, weights).tolist() == pytest.approx([1.0, 1.0, 1.0])
