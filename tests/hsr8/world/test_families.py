"""The rules that worlds of all families obey, without their certificates."""

from itertools import combinations
from math import atan2, degrees, hypot

import numpy as np
import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.scenario.world import ROBOT_RADIUS
from hsr8.world.field import fairness
from hsr8.world.field.attempt import Attempt, CrowdedError
from hsr8.world.field.encounter import NominalWalk
from hsr8.world.field.motion import Circle, Passage, Shuttle
from hsr8.world.field.wander import Wander

FAMILIES = (
    "course",
    "crowd",
    "dense",
    "fast",
    "conflict",
    "behind",
    "corridor",
    "crossing",
    "blind-corner",
)
SEEDS = range(2)
TIMES = np.arange(0.0, 240.0, 0.5).tolist()


def drawn(scenario, seed):
    rng = np.random.default_rng(seed)
    while True:
        try:
            return Attempt(scenario, rng).layout()
        except CrowdedError:
            pass


@pytest.fixture(scope="module", params=FAMILIES)
def family(request):
    scenario = load_scenario(request.param)
    return scenario, [drawn(scenario, seed) for seed in SEEDS]


def test_nothing_overlaps_at_the_start(family):
    for layout in family[1]:
        for a, b in combinations(layout.obstacles, 2):
            assert hypot(*np.subtract(a.position, b.position)) > a.radius + b.radius
        for o in layout.obstacles:
            gap = hypot(*np.subtract(o.position, layout.start[:2])) - o.radius
            assert gap >= (fairness.START_TO_MOVER if o.motion else fairness.START_TO_STATIC) - 1e-9


def test_movers_stay_in_the_field_and_touch_nothing(family):
    for layout in family[1]:
        movers = layout.motion()
        radii = np.array([o.radius for o in layout.movers])
        half = 0.5 * np.asarray(layout.field_size)
        places = np.array([movers.positions(time) for time in TIMES])
        assert (np.abs(places) <= half - radii[:, None]).all()
        for o in layout.static:
            gaps = np.hypot(*np.moveaxis(places - o.position, 2, 0)) - radii - o.radius
            # Lanes are points when they are drawn, up to a few centimetres apart.
            assert gaps.min() >= fairness.LANE_TO_STATIC - 0.01
        for i, k in combinations(range(len(radii)), 2):
            gap = np.hypot(*(places[:, i] - places[:, k]).T).min()
            assert gap > radii[i] + radii[k]


def test_speeds_are_those_asked_for(family):
    scenario, layouts = family
    world, top = scenario.world, scenario.robot.speed.vx
    for layout in layouts:
        speeds = layout.motion().top_speeds() / top
        assert len(speeds) == world.n_moving + world.encounters.n
        roaming, meeting = speeds[: world.n_moving], speeds[world.n_moving :]
        for found, (low, high) in (
            (roaming, world.speed_ratio),
            (meeting, world.encounters.speed_ratio),
        ):
            assert ((low - 1e-9 <= found) & (found <= high + 1e-9)).all()


def test_points_can_be_stood_on(family):
    for layout in family[1]:
        for point in layout.waypoints.tolist():
            for o in layout.static:
                assert hypot(*np.subtract(o.position, point)) - o.radius > ROBOT_RADIUS + 0.05


@pytest.mark.parametrize("name", ["conflict", "behind"])
def test_encounters_run_into_who_walks_straight_on(name):
    scenario = load_scenario(name)
    encounters = scenario.world.encounters
    layout = drawn(scenario, 5)
    pace = encounters.pace * scenario.robot.speed.vx
    places = [layout.start[:2], *map(tuple, layout.waypoints.tolist())]
    walk = NominalWalk(places, pace)
    low, high = encounters.bearing_deg
    for mover in layout.movers:
        gaps = []
        for time in np.arange(0.0, walk.duration, 0.1).tolist():
            place, _ = walk.at(time)
            gaps.append(hypot(*np.subtract(mover.motion.position(time), place)))
        meeting = 0.1 * int(np.argmin(gaps))
        assert min(gaps) < 0.05
        # Shortly before, it is seen under the bearing asked for.
        before = meeting - 0.8
        place, way = walk.at(before)
        if hypot(*np.subtract(way, walk.at(meeting)[1])) > 1e-9:
            continue  # round a via point
        see = np.subtract(mover.motion.position(before), place)
        bearing = abs(degrees(np.angle(complex(*see) / complex(*way))))
        assert low - 15.0 <= bearing <= high + 15.0


def test_a_crowd_shuttles_circles_and_wanders():
    laws = {type(o.motion) for seed in range(3) for o in drawn(load_scenario("crowd"), seed).movers}
    assert laws == {Shuttle, Circle, Wander}


def test_one_way_movers_go_once():
    layout = drawn(load_scenario("conflict"), 1)
    assert {type(o.motion) for o in layout.movers} == {Passage}


@pytest.mark.parametrize("name", ["behind", "conflict"])
def test_nothing_that_stood_sets_off_beside_the_robot(name):
    scenario = load_scenario(name)
    pace = scenario.world.encounters.pace * scenario.robot.speed.vx
    gaps = []
    for seed in range(4):
        layout = drawn(scenario, seed)
        walk = NominalWalk([layout.start[:2], *map(tuple, layout.waypoints)], pace)
        for mover in layout.movers:
            if mover.motion.depart > 0.0:
                there = walk.at(mover.motion.depart)[0]
                gaps.append(hypot(*np.subtract(mover.position, there)) - mover.radius)
    assert len(gaps) > 3
    assert min(gaps) >= fairness.START_TO_MOVER - 1e-9


def test_the_robot_cannot_slip_through_a_wall():
    layout = drawn(load_scenario("corridor"), 0)
    upper = sorted(o.position for o in layout.static if o.position[1] > 0.0)
    gaps = np.diff([x for x, _ in upper]) - 2.0 * layout.static[0].radius
    assert (gaps < 2.0 * ROBOT_RADIUS).all()
    assert atan2(*np.ptp(upper, axis=0)[::-1]) == 0.0
