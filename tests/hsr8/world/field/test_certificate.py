from dataclasses import replace
from math import pi

import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.robot import SpeedEnvelope
from hsr8.scenario.world import ROBOT_RADIUS
from hsr8.world.field.certificate import VIA_REACHED, certify, min_clearance, straight_length
from hsr8.world.field.generator import draw_layout, draw_world
from hsr8.world.field.layout import Layout, Obstacle
from hsr8.world.field.motion import Circle, Passage, Shuttle
from hsr8.world.field.wander import Wander

SPEED = SpeedEnvelope()
DIAGONAL = 0.075  # a lattice of 0.1 m has its nearest place within half a diagonal [m]


def layout(obstacles=(), waypoints=((1.0, 0.0),), size=(3.0, 1.2)):
    return Layout(size, tuple(obstacles), (), (-1.0, 0.0, 0.0), np.array(waypoints), None, False)


def wall(x=0.0):
    return [Obstacle((x, y), 0.1, 0.3, "red") for y in (-0.45, -0.15, 0.15, 0.45)]


def sampled(path, step=0.01):
    """Times (n,) and places (n, 3) on a path, densely."""
    times = np.arange(0.0, path[-1, 0] + step, step)
    return times, np.stack([np.interp(times, path[:, 0], path[:, k]) for k in (1, 2, 3)], axis=1)


def assert_walks_through(world, path, speed):
    """The path obeys the speeds, touches nothing, and passes all points in order."""
    times, places = sampled(path)
    steps = np.diff(path, axis=0)
    pace = np.hypot(steps[:, 1], steps[:, 2]) / steps[:, 0]
    assert pace.max() <= speed.vx + 1e-9
    assert (np.abs(steps[:, 3]) / steps[:, 0]).max() <= speed.wz + 1e-9
    # It walks forward only, and turns on the spot.
    going = pace > 1e-9
    along = np.cos(path[1:, 3]) * steps[:, 1] + np.sin(path[1:, 3]) * steps[:, 2]
    assert along[going] == pytest.approx(pace[going] * steps[going, 0])
    assert (steps[going, 3] == 0.0).all()
    for o in world.obstacles:
        where = o.motion.position if o.motion else lambda _, o=o: o.position
        at = np.array([where(time) for time in times.tolist()])
        assert np.hypot(*(places[:, :2] - at).T).min() > o.radius + ROBOT_RADIUS
    since = 0
    for k, point in enumerate(world.waypoints.tolist()):
        reach = DIAGONAL if k == len(world.waypoints) - 1 and not world.endless else VIA_REACHED
        near = np.flatnonzero(np.hypot(*(places[since:, :2] - point).T) <= reach + 1e-6)
        assert len(near), f"point {k} is not passed"
        since += near[0]
    if world.goal_heading is not None:
        off = (path[-1, 3] - world.goal_heading + pi) % (2.0 * pi) - pi
        assert abs(off) <= pi / 8.0 + 1e-9


def mirrored(world):
    """The same world with y turned round."""

    def law(motion):
        if isinstance(motion, Shuttle | Passage):
            return replace(motion, start=flip(motion.start), end=flip(motion.end))
        if isinstance(motion, Circle):
            return replace(
                motion, centre=flip(motion.centre), speed=-motion.speed, angle=-motion.angle
            )
        if isinstance(motion, Wander):
            return replace(motion, track=tuple(map(flip, motion.track)))
        return motion

    def flip(point):
        return point[0], -point[1]

    x, y, heading = world.start
    return replace(
        world,
        obstacles=tuple(
            replace(o, position=flip(o.position), motion=law(o.motion)) for o in world.obstacles
        ),
        start=(x, -y, -heading),
        waypoints=world.waypoints * (1.0, -1.0),
        goal_heading=None if world.goal_heading is None else -world.goal_heading,
    )


@pytest.mark.parametrize(
    "name", ["quick", "course", "crowd", "dense", "conflict", "behind", "corridor"]
)
def test_the_path_of_a_certificate_is_walked_without_contact(name):
    scenario = load_scenario(name)
    world = draw_world(scenario, 1001)
    assert world.certificate.solvable
    path = world.certificate.path
    assert path[0].tolist() == [0.0, *world.layout.start]
    assert_walks_through(world.layout, path, scenario.robot.speed)
    assert min_clearance(world.layout, path) >= 0.02


@pytest.mark.parametrize("name", ["quick", "crowd", "conflict"])
def test_a_mirrored_world_has_a_mirrored_certificate(name):
    scenario = load_scenario(name)
    world = draw_world(scenario, 1002)
    turned = mirrored(world.layout)
    certificate = certify(turned, scenario.robot.speed)
    assert certificate.time == pytest.approx(world.certificate.time)
    mirror = world.certificate.path * (1.0, 1.0, -1.0, -1.0)
    assert_walks_through(turned, mirror, scenario.robot.speed)


def test_a_robot_that_turns_slower_needs_longer():
    world = layout(waypoints=((0.5, 0.0), (0.5, 0.4)))
    usual = certify(world, SPEED)
    slow = certify(world, SpeedEnvelope(wz=0.2))
    # A right angle, but for what the width of the via point saves.
    assert slow.time - usual.time > 0.5 * (0.5 * pi) * (1.0 / 0.2 - 1.0 / 0.8)


def test_a_world_without_a_way_is_drawn_again():
    # A wall parts the field: goals on the far side cannot be reached.
    changes = [
        "world.wall=[{start=[0.0, -1.85], end=[0.0, 1.85]}]",
        "world.n_moving=0",
        "world.n_static=0",
        "robot.start.position=[-1.0, 0.0]",
        "mission.via_points=0",
        "mission.leg=[0.3, 2.5]",
    ]
    scenario = load_scenario("quick", changes)
    worlds = [draw_world(scenario, seed) for seed in range(6)]
    assert any(world.rejected for world in worlds)
    assert all(world.certificate.solvable for world in worlds)
    assert all(world.layout.waypoints[-1, 0] < 0.0 for world in worlds)


def test_an_impossible_world_is_an_error_that_says_how_often_it_was_tried():
    closed = "[{start=[0.0, -1.85], end=[0.0, 1.85]}]"
    changes = [f"world.wall={closed}", "world.n_moving=0", "world.n_static=0"]
    changes += [
        "robot.start.position=[-1.0, 0.0]",
        "mission.via_points=0",
        "mission.leg=[2.0, 2.9]",
    ]
    with pytest.raises(ScenarioError, match=r"no feasible path [0-9]+ times"):
        draw_layout(load_scenario("quick", changes), 0)


def test_a_world_placed_by_hand_is_what_it_is():
    scenario = load_scenario("fig4c", ["world.wall=[{start=[0.0, -2.35], end=[0.0, 2.35]}]"])
    world = draw_world(scenario, 0)
    assert not world.certificate.solvable
    assert world.certificate.points_reached == 0
    assert world.rejected == 0


def test_an_empty_field_takes_the_straight_way_at_full_speed():
    found = certify(layout(), SPEED)
    assert found.solvable
    assert found.time == pytest.approx(2.0 / SPEED.vx, abs=0.1 / SPEED.vx)
    assert found.length == pytest.approx(2.0, abs=0.1)


def test_a_wall_is_no_way():
    found = certify(layout(wall()), SPEED)
    assert not found.solvable
    assert found.points_reached == 0


def test_points_before_a_wall_are_counted():
    found = certify(layout(wall(0.5), ((-0.4, 0.0), (1.0, 0.0))), SPEED)
    assert (found.solvable, found.points_reached, found.points) == (False, 1, 2)


def test_a_mover_that_sweeps_a_narrow_corridor_stops_everybody():
    sweeper = Obstacle((1.2, 0.0), 0.12, 0.3, "red", Shuttle((1.2, 0.0), (-1.2, 0.0), 0.15))
    corridor = layout([sweeper], size=(3.0, 0.44))
    assert not certify(corridor, SPEED).solvable
    assert certify(layout([sweeper], size=(3.0, 2.0)), SPEED).solvable


def test_nothing_to_reach_is_reached():
    assert certify(layout(waypoints=np.zeros((0, 2))), SPEED).solvable


def test_straight_length_adds_the_legs():
    assert straight_length(layout(waypoints=((1.0, 0.0), (1.0, 0.5)))) == 2.5
