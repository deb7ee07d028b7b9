import numpy as np
import pytest

from hsr8.recorder.log import plan_layer
from hsr8.recorder.log.plan_layer import along, grid


class Whirl:
    """A field that leads round the origin, nowhere in its middle."""

    def at(self, points):
        return 3.0 * np.stack([-points[..., 1], points[..., 0]], axis=-1)


@pytest.mark.parametrize("here", [(0.0, 0.0), (0.11, -2.07)])
def test_the_grid_surrounds_the_robot_and_stays_where_it_is(here):
    points = grid(np.array(here))
    assert np.hypot(*(points - here).T).max() <= plan_layer.REACH
    assert points / plan_layer.SPACING == pytest.approx(np.round(points / plan_layer.SPACING))
    assert np.abs(points.mean(axis=0) - here).max() < plan_layer.SPACING
    moved = grid(np.add(here, (0.02, 0.0)))
    common = {tuple(p) for p in points.round(6)} & {tuple(p) for p in moved.round(6)}
    assert len(common) > 0.8 * len(points)


def test_the_way_follows_the_field():
    way = along(Whirl(), np.array([1.0, 0.0]), np.array([9.0, 9.0]))
    assert len(way) == plan_layer.STRIDES + 1
    assert np.hypot(*np.diff(way, axis=0).T) == pytest.approx(plan_layer.STRIDE)
    assert np.hypot(*way.T) == pytest.approx(1.0, abs=0.1)
    angles = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    assert (np.diff(angles) > 0.0).all()


def test_the_way_ends_at_the_destination():
    class Right:
        def at(self, points):
            return np.array([1.0, 0.0])

    way = along(Right(), np.zeros(2), np.array([0.3, 0.0]))
    assert way[-1] == pytest.approx([0.3, 0.0])
    assert (np.diff(way[:, 0]) > 0.0).all()
