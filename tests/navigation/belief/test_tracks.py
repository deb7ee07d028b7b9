import dataclasses
from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.tracks import Tracks, join, max_deviation


def test_max_deviation_is_that_of_the_eigenvalues_and_ignores_rotation():
    rng = np.random.default_rng(0)
    a = rng.normal(size=(50, 2, 2))
    p = a @ a.transpose(0, 2, 1)
    expected = np.sqrt(np.linalg.eigvalsh(p)[:, -1])
    assert [max_deviation(q) for q in p] == pytest.approx(expected)
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s], [s, c]])
    assert [max_deviation(q) for q in turn @ p @ turn.T] == pytest.approx(expected)


def equal(one, other):
    """Return whether two tracks have the same values."""
    fields = [f.name for f in dataclasses.fields(one) if f.name != "particles"]
    pairs = [(getattr(one, name), getattr(other, name)) for name in fields]
    if one.particles is not None:
        names = [f.name for f in dataclasses.fields(one.particles)]
        pairs += [(getattr(one.particles, n), getattr(other.particles, n)) for n in names]
    same = (one.particles is None) == (other.particles is None)
    return same and all(np.array_equal(a, b) and type(a) is type(b) for a, b in pairs)


def some(track):
    cloud = ([[1.0, 0.0], [2.0, 0.0]], [[0.1, 0.0], [0.0, 0.2]], [0.5, 0.5])
    lost = track((9.0, 9.0), (0.1, 0.0), id=4, age=2.0, particles=cloud, turn_rates=[0.1, 0.2])
    return [
        track((1.0, 0.5), (0.3, -0.4), id=2, sigma=0.02, radius=0.07, reach=0.3, turn_rate=0.2),
        lost,
        track((0.0, 2.0), motion=Motion.UNKNOWN, id=7, hits=3, age=0.5),
    ]


def test_tracks_as_an_array_are_the_same_one_by_one(track):
    plain = some(track)
    array = Tracks.of(plain)
    assert Tracks.of(array) is array
    assert len(array) == 3
    assert all(equal(a, b) for a, b in zip(array, plain, strict=True))
    assert equal(array[1], plain[1])
    assert equal(array[1:][1], plain[2])
    assert array.speed == pytest.approx([0.5, 0.1, 0.0])
    assert array.sigma == pytest.approx([0.02, 0.01, 0.01])
    assert array.moving.tolist() == [True, True, False]
    assert not array.static.any()
    assert array.lost.tolist() == [False, True, False]


def test_two_sets_become_one(track):
    ours, landmark = some(track), [replace(track((2.0, 2.0), id=-1), label="cyan/yellow")]
    for first, second in ((landmark, ours), (ours, landmark), (ours, ours), ([], ours)):
        both = join(first, second)
        assert all(equal(a, b) for a, b in zip(both, [*first, *second], strict=True))


def test_tracks_move_at_constant_velocity(track):
    before = Tracks.of(some(track))
    after = before.moved(0.5)
    assert after[0].position == pytest.approx([1.15, 0.3])
    assert before[0].position == pytest.approx([1.0, 0.5])
    assert after[2].position == pytest.approx(before[2].position)


def test_selection_keeps_rows_together(track):
    tracks = [track((i, 2 * i), (0.1 * i, 0.0), id=i) for i in range(4)]
    part = Tracks.of(tracks).where(np.array([False, True, False, True]))
    assert part.ids.tolist() == [1, 3]
    assert part.position[:, 1] == pytest.approx([2, 6])
    assert part.speed == pytest.approx([0.1, 0.3])


def test_possible_positions_are_those_of_tracks_and_the_particles_of_lost_ones(track):
    cloud = ([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], np.zeros((3, 2)), [0.5, 0.3, 0.2])
    tracks = [track((0.0, 1.0)), track((9.0, 9.0), particles=cloud), track((0.0, 2.0))]
    owner, positions, weights = Tracks.of(tracks).possible_positions()
    assert owner.tolist() == [0, 1, 1, 1, 2]
    assert positions.tolist() == [[0, 1], [1, 0], [2, 0], [3, 0], [0, 2]]
    assert np.bincount(owner, weights).tolist() == pytest.approx([1.0, 1.0, 1.0])
