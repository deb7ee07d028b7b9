import re
from itertools import combinations, pairwise
from math import atan2, degrees, hypot

import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.world.field.attempt import Attempt, CrowdedError, FairDistances
from hsr8.world.field.encounter import NominalWalk
from hsr8.world.field.generator import MAX_WORLDS, draw_layout
from hsr8.world.field.motion import Circle, Passage, Shuttle, Wander

PLAIN = ("course", "paper", "quick")  # shuttles alone, drawn without walls
FAMILIES = ("crowd", "dense", "fast", "conflict", "behind", "corridor", "crossing", "blind-corner")
SAMPLED = 0.01  # lanes are drawn as points: their distances are this exact [m]
TIMES = np.arange(0.0, 240.0, 0.5)
FAIR = FairDistances.of(load_scenario("course"))


def apart(a, b):
    return hypot(a[0] - b[0], a[1] - b[1])


def drawn(scenario, seed):
    """Layout of an attempt; the rules hold with and without a certificate."""
    rng = np.random.default_rng(seed)
    while True:
        try:
            return Attempt(scenario, rng).layout()
        except CrowdedError:
            pass


@pytest.fixture(scope="module", params=PLAIN + FAMILIES)
def worlds(request):
    scenario = load_scenario(request.param)
    seeds = range(1000, 1025) if request.param in PLAIN else range(2)
    return scenario, [drawn(scenario, seed) for seed in seeds]


def test_counts_sizes_and_speeds_are_in_the_range_of_the_scenario(worlds):
    scenario, layouts = worlds
    world, top = scenario.world, scenario.robot.speed.vx
    low, high = world.radius
    for layout in layouts:
        assert len(layout.static) >= world.n_static
        assert layout.obstacles == layout.static + layout.movers
        assert all(low <= o.radius <= high for o in layout.obstacles if o in layout.movers)
        speeds = layout.motion().top_speeds() / top
        assert len(speeds) == world.n_moving + world.encounters.n
        parts = np.split(speeds, [world.n_moving])
        ranges = (world.speed_ratio, world.encounters.speed_ratio)
        for ratio, (slow, fast) in zip(parts, ranges, strict=True):
            assert ((slow - 1e-9 <= ratio) & (ratio <= fast + 1e-9)).all()


def test_the_robot_fits_between_drawn_obstacles_and_none_overlap(worlds):
    scenario, layouts = worlds
    for layout in layouts:
        for a, b in combinations(layout.obstacles, 2):
            both_static = a.motion is None and b.motion is None and not scenario.world.wall
            room = FAIR.static_gap if both_static else 0.0
            assert apart(a.position, b.position) - a.radius - b.radius >= room - 1e-9


def test_the_start_is_clear(worlds):
    for layout in worlds[1]:
        for o in layout.obstacles:
            room = FAIR.start_to_mover if o.motion else FAIR.start_to_static
            assert apart(o.position, layout.start) - o.radius >= room - 1e-9


def test_points_are_clear_of_static_obstacles_and_apart(worlds):
    scenario, layouts = worlds
    for layout in layouts:
        points = layout.waypoints.tolist()
        room = scenario.robot.radius + 0.05 if scenario.world.wall else FAIR.point_to_static
        for point in points:
            for o in layout.static:
                assert apart(o.position, point) - o.radius >= room - 1e-9
        if hasattr(scenario.mission, "leg"):
            shortest, longest = scenario.mission.leg
            legs = [apart(a, b) for a, b in pairwise([layout.start[:2], *points])]
            assert all(shortest - 1e-9 <= leg <= longest + 1e-9 for leg in legs)
            if not layout.endless:
                assert all(apart(a, b) >= shortest - 1e-9 for a, b in combinations(points, 2))


def test_movers_stay_in_the_field_and_never_pin_the_robot_or_meet(worlds):
    for layout in worlds[1]:
        half = 0.5 * np.asarray(layout.field_size)
        radii = np.array([o.radius for o in layout.movers])
        positions = layout.motion().positions(TIMES)
        assert (np.abs(positions) <= half - radii[:, None]).all()
        for o in layout.static:
            gaps = np.hypot(*np.moveaxis(positions - o.position, 2, 0)) - radii - o.radius
            assert (gaps >= FAIR.lane_to_static - SAMPLED).all()
        for i, k in combinations(range(len(radii)), 2):
            gaps = np.hypot(*(positions[:, i] - positions[:, k]).T)
            assert gaps.min() > radii[i] + radii[k]


def test_shuttles_reverse_away_from_the_goal(worlds):
    for layout in (layout for layout in worlds[1] if not layout.endless):
        for o in (o for o in layout.movers if isinstance(o.motion, Shuttle)):
            for end in (o.motion.start, o.motion.end):
                gap = apart(end, layout.waypoints[-1]) - o.radius
                assert gap >= FAIR.lane_to_goal - 1e-9


@pytest.mark.parametrize("name", ["conflict", "behind"])
def test_encounters_meet_a_robot_that_walks_straight(name):
    scenario = load_scenario(name)
    encounters = scenario.world.encounters
    low, high = encounters.bearing_deg
    waits = []
    for seed in range(2):
        layout = drawn(scenario, seed)
        assert {type(o.motion) for o in layout.movers} == {Passage}
        points = [layout.start[:2], *map(tuple, layout.waypoints.tolist())]
        walk = NominalWalk(points, encounters.pace * scenario.robot.speed.vx)
        for mover in layout.movers:
            if mover.motion.depart > 0.0:  # a waiting mover departs away from the robot
                robot = walk.at(mover.motion.depart)[0]
                waits.append(apart(mover.position, robot) - mover.radius)
            times = np.arange(0.0, walk.duration, 0.05).tolist()
            gaps = [apart(mover.motion.position(time), walk.at(time)[0]) for time in times]
            meeting = times[int(np.argmin(gaps))]
            assert min(gaps) < 0.05
            before = meeting - 0.8  # the robot sees it at the bearing of the scenario
            if before < mover.motion.depart:
                continue
            robot, velocity = walk.at(before)
            if apart(velocity, walk.at(meeting)[1]) > 1e-9:
                continue  # around a via point
            sight = np.subtract(mover.motion.position(before), robot)
            bearing = abs(degrees(np.angle(complex(*sight) / complex(*velocity))))
            assert low - 15.0 <= bearing <= high + 15.0
    assert len(waits) > 3
    assert min(waits) >= FAIR.start_to_mover - 1e-9


def test_a_crowd_shuttles_circles_and_wanders():
    crowd = load_scenario("crowd")
    motions = {type(o.motion) for seed in range(3) for o in drawn(crowd, seed).movers}
    assert motions == {Shuttle, Circle, Wander}


def test_walls_have_no_gap_for_the_robot():
    layout = drawn(load_scenario("corridor"), 0)
    upper = sorted(o.position for o in layout.static if o.position[1] > 0.0)
    gaps = np.diff([x for x, _ in upper]) - 2.0 * layout.static[0].radius
    assert (gaps < 2.0 * 0.12).all()
    assert atan2(*np.ptp(upper, axis=0)[::-1]) == 0.0


def test_the_seed_determines_the_world():
    scenario = load_scenario("course")
    first, again, other = (draw_layout(scenario, seed) for seed in (5, 5, 6))
    assert first.obstacles == again.obstacles != other.obstacles
    assert first.start == again.start != other.start
    assert first.goal_heading == again.goal_heading
    np.testing.assert_array_equal(first.waypoints, again.waypoints)
    changed = load_scenario("course", ["camera.preset=ideal", "sensors.gyro=0.0"])
    assert draw_layout(changed, 5).obstacles == first.obstacles


def test_a_world_without_room_is_an_error_after_a_few_attempts():
    with pytest.raises(ScenarioError, match=r"no fair world.*world\.n_static"):
        draw_layout(load_scenario("quick", ["world.n_static=40"]), 1)
    with pytest.raises(ScenarioError, match="no fair world") as error:
        draw_layout(load_scenario("course", ["world.n_moving=30"]), 0)
    attempts = int(re.search(r"(\d+) attempts", str(error.value))[1])
    assert 1 <= attempts < MAX_WORLDS / 2


def test_objects_placed_by_hand_are_at_their_positions():
    layout = draw_layout(load_scenario("fig4c"), 0)
    (mover,) = layout.movers
    assert mover.position == (1.6, 0.02)
    assert mover.motion.velocity(0.0) == pytest.approx((-0.10, 0.0))
    assert layout.start == (-2.0, 0.0, 0.0)
    assert layout.waypoints.tolist() == [[1.8, 0.0]]
    assert layout.goal_heading == 0.0


def test_drawn_obstacles_keep_clear_of_those_placed_by_hand():
    hand = "world.obstacle=[{position=[0.0, 0.0], radius=0.3}]"
    for seed in range(5):
        placed, *others = draw_layout(load_scenario("course", [hand]), seed).static
        assert placed.position == (0.0, 0.0)
        for o in others:
            gap = apart(o.position, (0.0, 0.0)) - o.radius - placed.radius
            assert gap >= FAIR.static_gap - 1e-9


@pytest.mark.parametrize("name", ["fig4a", "fig4b", "fig4c"])
def test_situations_of_the_paper_are_collisions_without_a_reaction(name):
    """(a), (c): walking straight on at full speed; (b): standing still."""
    layout = draw_layout(load_scenario(name), 0)
    (mover,) = layout.movers
    speed = 0.0 if name == "fig4b" else 0.2
    gaps = [
        apart(mover.motion.position(t), (-2.0 + speed * max(0.0, t - 1.0), 0.0)) - mover.radius
        for t in np.arange(0.0, 25.0, 0.05).tolist()
    ]
    assert min(gaps) < 0.05
