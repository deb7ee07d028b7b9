import numpy as np

from hsr8.world.certificate import CELL, LAYER, certify, straight_length
from hsr8.world.layout import Layout, Obstacle
from hsr8.world.motion import Shuttle


def layout(obstacles=(), waypoints=((1.0, 0.0),), size=(3.0, 1.2)):
    return Layout(size, tuple(obstacles), (), (-1.0, 0.0, 0.0), np.array(waypoints), None, False)


def wall(x=0.0):
    return [Obstacle((x, y), 0.1, 0.3, "red") for y in (-0.45, -0.15, 0.15, 0.45)]


def test_an_empty_field_takes_the_straight_way_at_the_slow_speed():
    found = certify(layout())
    assert found.solvable
    assert abs(found.time - (2.0 - 0.15) * LAYER / CELL) <= 3 * LAYER


def test_a_wall_is_no_way():
    found = certify(layout(wall()))
    assert not found.solvable
    assert found.points_reached == 0


def test_points_before_a_wall_are_counted():
    found = certify(layout(wall(0.5), ((-0.4, 0.0), (1.0, 0.0))))
    assert (found.solvable, found.points_reached, found.points) == (False, 1, 2)


def test_a_mover_that_sweeps_a_narrow_corridor_stops_everybody():
    sweeper = Obstacle((1.2, 0.0), 0.12, 0.3, "red", Shuttle((1.2, 0.0), (-1.2, 0.0), 0.15))
    corridor = layout([sweeper], size=(3.0, 0.44))
    assert not certify(corridor).solvable
    assert certify(layout([sweeper], size=(3.0, 2.0))).solvable


def test_nothing_to_reach_is_reached():
    assert certify(layout(waypoints=np.zeros((0, 2)))).solvable


def test_straight_length_adds_the_legs():
    assert straight_length(layout(waypoints=((1.0, 0.0), (1.0, 0.5)))) == 2.5
