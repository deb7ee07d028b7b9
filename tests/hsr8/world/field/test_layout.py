import itertools

import numpy as np
import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.world.field.generator import draw_layout
from hsr8.world.field.layout import (
    BEACON_COLORS,
    BEACON_OFFSET,
    standard_beacons,
    with_first_moved,
)


@pytest.mark.parametrize("size", [(5.0, 5.0), (4.0, 2.0), (3.0, 9.0)])
def test_beacons_stand_on_the_rectangle_around_the_field(size):
    half = 0.5 * np.asarray(size) + BEACON_OFFSET
    for beacon in standard_beacons(size):
        share = np.abs(beacon.position) / half
        assert share.max() == pytest.approx(1.0, abs=1e-3)


def test_every_ordered_pair_of_colors_is_one_beacon():
    beacons = standard_beacons((5.0, 5.0))
    pairs = {(b.top, b.bottom) for b in beacons}
    assert pairs == set(itertools.permutations(BEACON_COLORS, 2))
    assert [b.name for b in beacons] == [f"{b.top}/{b.bottom}" for b in beacons]


def test_beacons_of_the_same_two_colors_are_far_apart():
    by_name = {b.name: np.asarray(b.position) for b in standard_beacons((5.0, 5.0))}
    for beacon in standard_beacons((5.0, 5.0)):
        twin = by_name[f"{beacon.bottom}/{beacon.top}"]
        assert np.linalg.norm(twin - beacon.position) > 5.0


def test_the_robot_knows_bounds_of_all_sizes_in_the_world():
    placed = {"world.obstacle": [{"position": [1.0, 1.0], "radius": 0.3}], "world.scale": 2.0}
    layout = draw_layout(load_scenario("quick", placed), 1)
    sizes = layout.sizes
    assert sizes.obstacle_radius == (0.05, 0.3)
    for obstacle in layout.obstacles:
        low, high = sizes.obstacle_height
        assert low <= obstacle.height <= high
        assert sizes.obstacle_radius[0] <= obstacle.radius <= sizes.obstacle_radius[1]
    assert {(b.radius, b.height) for b in layout.beacons} == {(0.1, 1.2)}


@pytest.mark.parametrize("size", [(5.0, 5.0), (8.0, 3.0), (3.0, 8.0)])
@pytest.mark.parametrize("distance", [-1.5, 0.5, 1.5])
def test_a_moved_beacon_is_where_it_is_and_not_where_it_is_known(size, distance):
    """It stays outside the border."""
    beacons = standard_beacons(size)
    first, *others = with_first_moved(beacons, distance, size)
    assert np.max(np.abs(first.position) - 0.5 * np.asarray(size)) > BEACON_OFFSET - 1e-9
    assert first.believed == beacons[0].position
    assert np.hypot(*np.subtract(first.position, first.believed)) == pytest.approx(abs(distance))
    assert tuple(others) == beacons[1:]
    assert all(b.believed == b.position for b in others)
