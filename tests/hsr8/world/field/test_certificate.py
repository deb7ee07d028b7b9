from dataclasses import replace
from math import pi

import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.robot import Robot, SpeedEnvelope
from hsr8.world.field.certificate import VIA_REACHED, certify, min_clearance
from hsr8.world.field.generator import draw_layout, draw_world
from hsr8.world.field.layout import Layout, Obstacle
from hsr8.world.field.motion import Circle, Passage, Shuttle, Wander

ROBOT = Robot()
DIAGONAL = 0.075  # maximum distance to the nearest cell of a lattice of 0.1 m [m]


def layout(obstacles=(), waypoints=((1.0, 0.0),), size=(3.0, 1.2)):
    return Layout(size, tuple(obstacles), (), (-1.0, 0.0, 0.0), np.array(waypoints), None, False)


def wall(x=0.0):
    return [Obstacle((x, y), 0.1, 0.3, "red") for y in (-0.45, -0.15, 0.15, 0.45)]


def sampled(path, step=0.01):
    """Return times (n,) and poses (n, 3) along a path."""
    times = np.arange(0.0, path[-1, 0] + step, step)
    return times, np.stack([np.interp(times, path[:, 0], path[:, k]) for k in (1, 2, 3)], axis=1)


def assert_walks_through(world, path, robot):
    """The path keeps the speed limits, touches nothing, and passes all points in order."""
    times, poses = sampled(path)
    speed = robot.speed
    steps = np.diff(path, axis=0)
    pace = np.hypot(steps[:, 1], steps[:, 2]) / steps[:, 0]
    assert pace.max() <= speed.vx + 1e-9
    assert (np.abs(steps[:, 3]) / steps[:, 0]).max() <= speed.wz + 1e-9
    going = pace > 1e-9
    along = np.cos(path[1:, 3]) * steps[:, 1] + np.sin(path[1:, 3]) * steps[:, 2]
    assert along[going] == pytest.approx(pace[going] * steps[going, 0])
    assert (steps[going, 3] == 0.0).all()
    for o in world.static:
        assert np.hypot(*(poses[:, :2] - o.position).T).min() > o.radius + robot.radius
    positions = world.motion().positions(times)
    for k, o in enumerate(world.movers):
        assert np.hypot(*(poses[:, :2] - positions[:, k]).T).min() > o.radius + robot.radius
    since = 0
    for k, point in enumerate(world.waypoints.tolist()):
        reach = DIAGONAL if k == len(world.waypoints) - 1 and not world.endless else VIA_REACHED
        near = np.flatnonzero(np.hypot(*(poses[since:, :2] - point).T) <= reach + 1e-6)
        assert len(near), f"point {k} is not passed"
        since += near[0]
    if world.goal_heading is not None:
        off = (path[-1, 3] - world.goal_heading + pi) % (2.0 * pi) - pi
        assert abs(off) <= pi / 8.0 + 1e-9


def mirrored(world):
    """Return the world mirrored at the x axis."""

    def flipped(motion):
        if isinstance(motion, Shuttle | Passage):
            return replace(motion, start=flip(motion.start), end=flip(motion.end))
        if isinstance(motion, Circle):
            centre = flip(motion.centre)
            return replace(motion, centre=centre, speed=-motion.speed, angle=-motion.angle)
        if isinstance(motion, Wander):
            return replace(motion, track=tuple(map(flip, motion.track)))
        return motion

    def flip(point):
        return point[0], -point[1]

    x, y, heading = world.start
    return replace(
        world,
        obstacles=tuple(
            replace(o, position=flip(o.position), motion=flipped(o.motion)) for o in world.obstacles
        ),
        start=(x, -y, -heading),
        waypoints=world.waypoints * (1.0, -1.0),
        goal_heading=None if world.goal_heading is None else -world.goal_heading,
    )


@pytest.mark.parametrize(
    "name", ["quick", "crowd", "conflict", "behind", "corridor", "pedestrians"]
)
def test_the_path_of_a_certificate_has_no_contact(name):
    scenario = load_scenario(name)
    world = draw_world(scenario, 1001)
    assert world.certificate.solvable
    path = world.certificate.path
    assert path[0].tolist() == [0.0, *world.layout.start]
    assert_walks_through(world.layout, path, scenario.robot)
    assert min_clearance(world.layout, path, scenario.robot.radius) >= 0.02


@pytest.mark.parametrize("name", ["crowd", "conflict"])
def test_a_mirrored_world_has_a_mirrored_certificate(name):
    scenario = load_scenario(name)
    world = draw_world(scenario, 1002)
    mirror = mirrored(world.layout)
    certificate = certify(mirror, scenario.robot)
    assert certificate.time == pytest.approx(world.certificate.time)
    path = world.certificate.path * (1.0, 1.0, -1.0, -1.0)
    assert_walks_through(mirror, path, scenario.robot)


def test_a_via_point_is_passed_at_the_distance_of_the_mission():
    world = layout(waypoints=((0.0, 0.4), (1.0, 0.0)))
    lengths = [certify(world, ROBOT, reached).length for reached in (0.01, 0.15, 0.4)]
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[0] > lengths[2] + 0.2


def test_a_robot_that_turns_slower_needs_longer():
    world = layout(waypoints=((0.5, 0.0), (0.5, 0.4)))
    usual = certify(world, ROBOT)
    slow = certify(world, Robot(speed=SpeedEnvelope(wz=0.2)))
    assert slow.time - usual.time > 0.5 * (0.5 * pi) * (1.0 / 0.2 - 1.0 / 0.8)


@pytest.mark.parametrize("first", [(0.0, 0.0), (0.03, 0.02), (0.0, -0.05)])
def test_a_point_at_the_start_is_reached_at_once(first):
    start = layout().start
    near = (start[0] + first[0], start[1] + first[1])
    assert certify(layout(waypoints=(near,)), ROBOT).solvable
    assert certify(layout(waypoints=(near, (start[0] + 0.5, start[1]))), ROBOT).solvable


DIVIDED = [  # a wall divides the field: points on the far side cannot be reached
    "world.wall=[{start=[0.0, -1.85], end=[0.0, 1.85]}]",
    "world.n_moving=0",
    "world.n_static=0",
    "robot.start.position=[-1.0, 0.0]",
    "mission.via_points=0",
]


def test_an_infeasible_world_is_drawn_again():
    scenario = load_scenario("quick", [*DIVIDED, "mission.leg=[0.3, 2.5]"])
    worlds = [draw_world(scenario, seed) for seed in range(6)]
    assert any(world.rejected for world in worlds)
    assert all(world.certificate.solvable for world in worlds)
    assert all(world.layout.waypoints[-1, 0] < 0.0 for world in worlds)


def test_only_infeasible_worlds_are_an_error():
    with pytest.raises(ScenarioError, match=r"no feasible path [0-9]+ times"):
        draw_layout(load_scenario("quick", [*DIVIDED, "mission.leg=[2.0, 2.9]"]), 0)


def test_a_world_placed_by_hand_is_never_rejected():
    scenario = load_scenario("fig4c", ["world.wall=[{start=[0.0, -2.35], end=[0.0, 2.35]}]"])
    world = draw_world(scenario, 0)
    assert (world.certificate.solvable, world.certificate.points_reached) == (False, 0)
    assert world.rejected == 0


def test_an_empty_field_is_crossed_straight_at_full_speed():
    certificate = certify(layout(), ROBOT)
    assert certificate.solvable
    assert certificate.time == pytest.approx(2.0 / ROBOT.speed.vx, abs=0.1 / ROBOT.speed.vx)
    assert certificate.length == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(
    ("x", "points", "reached"),
    [(0.0, ((1.0, 0.0),), 0), (0.5, ((-0.4, 0.0), (1.0, 0.0)), 1)],
)
def test_points_before_a_wall_are_counted(x, points, reached):
    certificate = certify(layout(wall(x), points), ROBOT)
    assert (certificate.solvable, certificate.points_reached) == (False, reached)
    assert certificate.points == len(points)


def test_a_mover_that_sweeps_a_narrow_corridor_blocks_it():
    sweeper = Obstacle((1.2, 0.0), 0.12, 0.3, "red", Shuttle((1.2, 0.0), (-1.2, 0.0), 0.15))
    corridor = layout([sweeper], size=(3.0, 0.44))
    assert not certify(corridor, ROBOT).solvable
    assert certify(layout([sweeper], size=(3.0, 2.0)), ROBOT).solvable
