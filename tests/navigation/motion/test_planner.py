from dataclasses import replace
from math import pi

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.motion.planner import Planner
from navigation.parameters.navigation import NavigationParameters

EXTENDED, PAPER = NavigationParameters.extended(), NavigationParameters.paper()
OFF = replace(
    PAPER,
    moving_obstacles=replace(
        PAPER.moving_obstacles, virtual_obstacle="off", velocity_modification="off"
    ),
)
BOTH = pytest.mark.parametrize("p", [EXTENDED, PAPER], ids=["extended", "paper"])


@BOTH
def test_a_free_path_is_walked_at_full_speed(p, belief, task, limits):
    decision = Planner(p, limits).plan(belief(), task())
    assert decision.velocity == pytest.approx([limits.vx, 0.0, 0.0])
    assert decision.direction == pytest.approx(0.0)
    assert decision.situation == "free"


@BOTH
def test_done_stands_and_lost_turns_on_the_spot(p, belief, task, limits):
    for b in (belief(), belief(lost=True)):
        assert Planner(p, limits).plan(b, task(done=True)).velocity == pytest.approx(0.0)
    lost = Planner(p, limits).plan(belief(lost=True), task()).velocity
    assert lost == pytest.approx([0.0, 0.0, p.velocity_mapping.lost_turn_rate])
    assert lost[2] > 0.0


@BOTH
def test_at_the_goal_it_turns_in_place(p, belief, task, limits):
    t = task((0.0, 0.0), 1.0, is_goal=True, aligning=True)
    decision = Planner(p, limits).plan(belief(), t)
    assert decision.velocity[:2] == pytest.approx(0.0)
    assert decision.velocity[2] == pytest.approx(limits.wz)
    near = task((0.0, 0.0), 0.1, is_goal=True, aligning=True)
    assert Planner(p, limits).plan(belief(), near).velocity[2] == pytest.approx(0.15)


def test_a_waiting_robot_steps_aside_for_a_mover(belief, task, track, limits):
    mover = track((0.6, 0.0), (-0.14, 0.0))
    t = task((0.0, 0.0), 0.0, is_goal=True, aligning=True)
    decision = Planner(EXTENDED, limits).plan(belief([mover]), t)
    assert np.hypot(*decision.velocity[:2]) > 0.02


@BOTH
def test_it_slows_down_at_the_goal_but_not_at_a_via_point(p, belief, task, limits):
    speeds = [
        Planner(p, limits).plan(belief(), task((0.1, 0.0), is_goal=g)).velocity[0]
        for g in (True, False)
    ]
    assert speeds[0] < 0.5 * limits.vx
    assert speeds[1] == pytest.approx(limits.vx)


def test_near_the_goal_the_body_faces_the_goals_heading(belief, task, limits):
    t = task((0.3, 0.0), pi / 2, is_goal=True)
    assert Planner(EXTENDED, limits).plan(belief(), t).velocity[2] > 0.5


def test_unseen_ground_ahead_is_walked_slowly(belief, task, limits):
    blind = belief(confidence=lambda x, y: 0.0 if x > 0.4 else 1.0)
    assert Planner(EXTENDED, limits).plan(blind, task()).speed == EXTENDED.unseen_ground.speed
    assert Planner(EXTENDED, limits).plan(belief(), task()).speed == limits.vx
    behind = belief(confidence=lambda x, y: 0.0 if x < 0.2 else 1.0)
    assert Planner(EXTENDED, limits).plan(behind, task()).speed == limits.vx


def test_decisions_do_not_depend_on_the_frame(belief, task, tracks, limits, rotation):
    rng = np.random.default_rng(0)
    a, shift = 1.2, np.array([0.7, -2.0])
    r = rotation(a)
    for p in (EXTENDED, PAPER):
        for _ in range(10):
            places, speeds = rng.uniform(-1.5, 1.5, (8, 2)), rng.normal(0, 0.1, (8, 2))
            speeds[:5] = 0.0
            here = tracks(places, speeds)
            there = tracks(places @ r.T + shift, speeds @ r.T)
            one = Planner(p, limits).plan(belief(here), task((1.0, 0.5), 0.3))
            pose = (*shift.tolist(), a)
            target = r @ [1.0, 0.5] + shift
            other = Planner(p, limits).plan(belief(there, pose), task(target, 0.3 + a))
            assert other.velocity == pytest.approx(one.velocity, abs=1e-6)
            assert other.situation == one.situation


def test_the_order_of_tracks_is_irrelevant(belief, task, track, limits):
    rng = np.random.default_rng(1)
    tracks = [track(c, id=i) for i, c in enumerate(rng.uniform(-1, 1, (10, 2)))]
    one = Planner(EXTENDED, limits).plan(belief(tracks), task())
    other = Planner(EXTENDED, limits).plan(belief(tracks[::-1]), task())
    assert one.velocity == pytest.approx(other.velocity)
    assert sorted(one.extended_radii) == sorted(other.extended_radii)


def test_movers_lost_for_long_are_left_to_the_safety_filter(belief, task, track, limits):
    cloud = ([[3.0, 3.0]], [[0.0, 0.0]], [1.0])
    lost = track((0.5, 0.0), (0.0, 0.05), age=4.0, particles=cloud)
    fresh = track((0.5, 0.0), (0.0, 0.05), age=0.2)
    assert Planner(EXTENDED, limits).plan(belief([lost]), task()).extended_radii == ()
    assert len(Planner(EXTENDED, limits).plan(belief([fresh]), task()).extended_radii) == 1


def test_a_definite_collision_makes_a_virtual_obstacle_in_the_paper(belief, task, track, limits):
    mover = track((0.6, 0.1), (-0.12, 0.0))
    decision = Planner(PAPER, limits).plan(belief([mover]), task())
    assert decision.situation == "path_change"
    assert [v.track_id for v in decision.virtual_obstacles] == [1]
    assert abs(decision.direction) > 0.05


@pytest.mark.parametrize("motion", [Motion.STATIC, Motion.UNKNOWN])
def test_an_obstacle_on_the_path_is_passed(motion, belief, task, track, limits, advance):
    pose = np.array([0.0, 0.02, 0.0])
    planner = Planner(EXTENDED, limits)
    least = 9.0
    for _ in range(40):
        decision = planner.plan(belief([track((0.8, 0.0), motion=motion)], pose), task((1.6, 0.0)))
        pose = advance(pose, decision.velocity)
        least = min(least, float(np.hypot(pose[0] - 0.8, pose[1])))
        if np.hypot(*(pose[:2] - [1.6, 0.0])) < 0.1:
            break
    assert np.hypot(*(pose[:2] - [1.6, 0.0])) < 0.15
    assert least > 0.20


def test_a_wall_is_passed_with_the_waypoint_search_and_not_without(belief, task, track, limits):
    wall = [track((1.0, y), id=k) for k, y in enumerate(np.arange(-0.6, 1.01, 0.2))]
    search = replace(EXTENDED, waypoint_search=replace(EXTENDED.waypoint_search, enabled=True))
    plain, round_it = (Planner(p, limits).plan(belief(wall), task()) for p in (EXTENDED, search))
    assert round_it.direction < -0.3
    assert abs(plain.direction) < abs(round_it.direction)


@pytest.mark.parametrize("name", ["grouping", "side_memory"])
def test_sides_are_chosen_once_for_the_whole_field(name, belief, task, track, limits):
    p = replace(EXTENDED, univector=replace(EXTENDED.univector, **{name: True}))
    planner = Planner(p, limits)
    pair = [track((0.45, 0.17), id=1), track((0.45, -0.18), id=2)]
    first = planner.plan(belief(pair), task()).direction
    again = planner.plan(belief(pair, pose=(0.0, 0.03, 0.0)), task()).direction
    assert np.sign(first) == np.sign(again) != 0.0


def test_a_mover_head_on_is_passed_with_the_printed_scheme_and_not_without(
    belief, task, track, limits, advance
):
    """Fig. 4 (c) in closed loop: lateral room grows at full speed until the bodies clear."""
    least = []
    for p in (PAPER, OFF):
        planner, pose = Planner(p, limits), np.zeros(3)
        gaps = []
        for step in range(30):
            mover = track((2.4 - 0.034 * step, 0.02), (-0.1, 0.0), radius=0.1)
            decision = planner.plan(belief([mover], pose), task((3.8, 0.0)))
            pose = advance(pose, decision.velocity)
            gaps.append(np.hypot(*(mover.position - pose[:2])) - 0.1 - p.univector.s_robot)
        least.append(min(gaps))
    assert least[0] > 0.0
    assert least[1] < least[0]


@BOTH
def test_the_field_of_a_decision_has_its_direction_at_the_robot(p, belief, task, track, limits):
    decision = Planner(p, limits).plan(belief([track((0.7, 0.15))]), task())
    u_x, u_y = decision.field.at(np.zeros(2))
    assert np.arctan2(u_y, u_x) == pytest.approx(decision.direction)


@BOTH
def test_evaluation_of_the_field_changes_no_decision(p, belief, task, track, limits):
    looked, blind = Planner(p, limits), Planner(p, limits)
    points = np.random.default_rng(0).uniform(-1.0, 2.0, (50, 2))
    for step in range(6):
        b = belief([track((1.2 - 0.1 * step, 0.1), (-0.14, 0.0)), track((0.7, -0.2), id=2)])
        one, other = looked.plan(b, task()), blind.plan(b, task())
        before = one.field.at(points)
        assert one.field.at(points).tolist() == before.tolist()
        assert one.velocity.tolist() == other.velocity.tolist()
        assert before.shape == points.shape


def test_a_robot_that_stands_has_no_field(belief, task, limits):
    assert Planner(EXTENDED, limits).plan(belief(), task(done=True)).field is None


def test_the_body_turns_for_a_fixed_camera_and_keeps_its_course(belief, task, limits):
    p = EXTENDED
    ahead = Planner(p, limits).plan(belief(), task())
    left = Planner(p, limits).plan(belief(), task(), 0.8)
    assert left.velocity[2] > ahead.velocity[2] == pytest.approx(0.0, abs=1e-9)
    assert left.velocity[1] / left.velocity[0] == pytest.approx(0.0, abs=1e-9)
    goal = task((0.05, 0.0), is_goal=True)
    assert Planner(p, limits).plan(belief(), goal, 0.8).velocity[2] == pytest.approx(0.0, abs=1e-9)
