import re
from itertools import combinations, pairwise
from math import hypot

import numpy as np
import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.world.field import fairness
from hsr8.world.field.attempt import Attempt
from hsr8.world.field.generator import MAX_WORLDS, draw_layout

SEEDS = range(1000, 1025)
SAMPLED = 0.002  # the drawing takes lanes as points: its distances are this exact [m]
TIMES = np.arange(0.0, 60.0, 0.25)


def apart(a, b):
    return hypot(a[0] - b[0], a[1] - b[1])


def drawn(scenario, seed):
    """The rules hold for every attempt, with a way through or without."""
    return Attempt(scenario, np.random.default_rng(seed)).layout()


@pytest.fixture(scope="module", params=["course", "paper", "quick"])
def worlds(request):
    scenario = load_scenario(request.param)
    return scenario, [drawn(scenario, seed) for seed in SEEDS]


def test_counts_and_ranges_are_those_asked_for(worlds):
    scenario, layouts = worlds
    low, high = scenario.world.radius
    slow, fast = (r * scenario.robot.speed.vx for r in scenario.world.speed_ratio)
    for layout in layouts:
        assert len(layout.static) == scenario.world.n_static
        assert len(layout.movers) == scenario.world.n_moving
        assert layout.obstacles == layout.static + layout.movers
        assert all(low <= o.radius <= high for o in layout.obstacles)
        speeds = np.hypot(*layout.motion().velocities(0.0).T)
        assert ((slow <= speeds + 1e-9) & (speeds <= fast + 1e-9)).all()


def test_the_robot_fits_between_static_obstacles(worlds):
    for layout in worlds[1]:
        for a, b in combinations(layout.static, 2):
            gap = apart(a.position, b.position) - a.radius - b.radius
            assert gap >= fairness.STATIC_GAP - 1e-9


def test_the_start_is_clear(worlds):
    for layout in worlds[1]:
        start = layout.start[:2]
        for o in layout.static:
            assert apart(o.position, start) - o.radius >= fairness.START_TO_STATIC - 1e-9
        for o in layout.movers:
            assert apart(o.position, start) - o.radius >= fairness.START_TO_MOVER - 1e-9


def test_points_are_clear_of_static_obstacles_and_apart(worlds):
    scenario, layouts = worlds
    shortest, longest = scenario.mission.leg
    for layout in layouts:
        for point in layout.waypoints.tolist():
            for o in layout.static:
                assert apart(o.position, point) - o.radius >= fairness.POINT_TO_STATIC - 1e-9
        legs = [apart(a, b) for a, b in pairwise([layout.start[:2], *layout.waypoints.tolist()])]
        assert all(shortest - 1e-9 <= leg <= longest + 1e-9 for leg in legs)
        if not layout.endless:
            assert all(
                apart(a, b) >= 1.2 - 1e-9 for a, b in combinations(layout.waypoints.tolist(), 2)
            )


def test_movers_never_pin_the_robot_nor_run_into_anything(worlds):
    for layout in worlds[1]:
        movers, half = layout.motion(), 0.5 * np.asarray(layout.field_size)
        radii = np.array([o.radius for o in layout.movers])
        for time in TIMES.tolist():
            places = movers.positions(time)
            assert (np.abs(places) <= half - radii[:, None]).all()
            for o in layout.static:
                gaps = np.hypot(*(places - o.position).T) - radii - o.radius
                assert (gaps >= fairness.LANE_TO_STATIC - SAMPLED).all()
            for i, k in combinations(range(len(radii)), 2):
                assert apart(places[i], places[k]) > radii[i] + radii[k]


def test_movers_turn_about_away_from_the_goal(worlds):
    for layout in worlds[1]:
        if layout.endless:
            continue
        for o in layout.movers:
            for end in (o.motion.start, o.motion.end):
                gap = apart(end, layout.waypoints[-1]) - o.radius
                assert gap >= fairness.LANE_TO_GOAL - 1e-9


def test_same_seed_same_world_other_seed_other_world():
    scenario = load_scenario("course")
    first, again, other = (draw_layout(scenario, seed) for seed in (5, 5, 6))
    assert first.obstacles == again.obstacles
    assert first.start == again.start
    assert first.goal_heading == again.goal_heading
    np.testing.assert_array_equal(first.waypoints, again.waypoints)
    assert first.obstacles != other.obstacles
    assert first.start != other.start


def test_sensors_and_camera_do_not_change_the_world():
    plain = draw_layout(load_scenario("course"), 3)
    other = draw_layout(load_scenario("course", ["camera.lens=narrow", "sensors.gyro=0.0"]), 3)
    assert plain.obstacles == other.obstacles


def test_a_world_without_room_is_an_error_that_says_what_to_change():
    with pytest.raises(ScenarioError, match=r"no fair world.*world\.n_static"):
        draw_layout(load_scenario("quick", ["world.n_static=40"]), 1)


def test_movers_without_room_are_given_up_soon():
    with pytest.raises(ScenarioError, match="no fair world") as refused:
        draw_layout(load_scenario("course", ["world.n_moving=30"]), 0)
    attempts = int(re.search(r"(\d+) attempts", str(refused.value))[1])
    assert 1 <= attempts < MAX_WORLDS / 2


def test_things_placed_by_hand_stand_where_they_are_put():
    layout = draw_layout(load_scenario("fig4c"), 0)
    (mover,) = layout.movers
    assert mover.position == (1.6, 0.02)
    assert mover.motion.velocity(0.0) == pytest.approx((-0.10, 0.0))
    assert layout.start == (-2.0, 0.0, 0.0)
    assert layout.waypoints.tolist() == [[1.8, 0.0]]
    assert layout.goal_heading == 0.0


def test_drawn_obstacles_keep_clear_of_those_placed_by_hand():
    hand = "world.obstacle=[{position=[0.0, 0.0], radius=0.3}]"
    for seed in SEEDS[:5]:
        layout = draw_layout(load_scenario("course", [hand]), seed)
        placed, *drawn = layout.static
        assert placed.position == (0.0, 0.0)
        for o in drawn:
            gap = apart(o.position, (0.0, 0.0)) - o.radius - placed.radius
            assert gap >= fairness.STATIC_GAP - 1e-9


def test_circles_can_be_drawn():
    layout = draw_layout(
        load_scenario("course", ['world.motions=["circle"]', "world.n_moving=2"]), 1
    )
    places = np.array([layout.motion().positions(t) for t in (0.0, 3.0)])
    assert (np.abs(places) < 2.5).all()
    assert (np.abs(places[1] - places[0]).max(axis=1) > 0.05).all()


def test_a_walk_has_nothing_to_reach():
    layout = draw_layout(load_scenario("walk"), 0)
    assert layout.waypoints.shape == (0, 2)
    assert not layout.endless
    assert layout.goal_heading is None


@pytest.mark.parametrize("name", ["fig4a", "fig4b", "fig4c"])
def test_collision_situations_are_collisions_for_who_does_not_react(name):
    """(a), (c): walking straight on at full speed; (b): standing still."""
    layout = draw_layout(load_scenario(name), 0)
    (mover,) = layout.movers
    speed = 0.0 if name == "fig4b" else 0.2
    gaps = [
        apart(mover.motion.position(t), (-2.0 + speed * max(0.0, t - 1.0), 0.0)) - mover.radius
        for t in np.arange(0.0, 25.0, 0.05).tolist()
    ]
    assert min(gaps) < 0.05
