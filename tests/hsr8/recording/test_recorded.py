from math import inf

import numpy as np
import pytest

from hsr8.recording import recorded
from hsr8.recording.recorded import Throttle, grid, path_along


class Whirl:
    """A field that leads round the origin, nowposition in its middle."""

    def at(self, points):
        return 3.0 * np.stack([-points[..., 1], points[..., 0]], axis=-1)


@pytest.mark.parametrize("position", [(0.0, 0.0), (0.11, -2.07)])
def test_the_grid_surrounds_the_robot_and_does_not_move(position):
    points = grid(np.array(position))
    assert np.hypot(*(points - position).T).max() <= recorded.REACH
    assert points / recorded.SPACING == pytest.approx(np.round(points / recorded.SPACING))
    assert np.abs(points.mean(axis=0) - position).max() < recorded.SPACING
    moved = grid(np.add(position, (0.02, 0.0)))
    common = {tuple(p) for p in points.round(6)} & {tuple(p) for p in moved.round(6)}
    assert len(common) > 0.8 * len(points)


def test_the_path_follows_the_field():
    path = path_along(Whirl(), np.array([1.0, 0.0]), np.array([9.0, 9.0]))
    assert len(path) == recorded.STEPS + 1
    assert np.hypot(*np.diff(path, axis=0).T) == pytest.approx(recorded.STEP)
    assert np.hypot(*path.T) == pytest.approx(1.0, abs=0.1)
    angles = np.unwrap(np.arctan2(path[:, 1], path[:, 0]))
    assert (np.diff(angles) > 0.0).all()


def test_the_path_ends_at_the_destination():
    class Right:
        def at(self, points):
            return np.array([1.0, 0.0])

    path = path_along(Right(), np.zeros(2), np.array([0.3, 0.0]))
    assert path[-1] == pytest.approx([0.3, 0.0])
    assert (np.diff(path[:, 0]) > 0.0).all()


def test_one_sample_per_period_passes():
    throttle = Throttle(0.06)
    due = [k for k in range(100) if throttle.due(0.02 * k)]
    assert due == list(range(0, 100, 3))


def test_without_a_period_every_sample_passes():
    throttle = Throttle(0.0)
    assert all(throttle.due(0.02 * k) for k in range(100))


def test_the_period_restarts_after_a_gap():
    throttle = Throttle(1.0)
    assert [throttle.due(time) for time in (0.0, 0.9, 1.7, 2.0, 2.7)] == [
        True,
        False,
        True,
        False,
        True,
    ]


def test_one_sample_passes_in_an_infinite_period():
    throttle = Throttle(inf)
    assert [throttle.due(time) for time in (0.0, 1.0)] == [True, False]
