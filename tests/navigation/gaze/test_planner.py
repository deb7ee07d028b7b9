from dataclasses import replace

import numpy as np
import pytest

from navigation.gaze.planner import GazePlanner, GazeTiming
from navigation.parameters.gaze import GazeParameters
from navigation.parameters.navigation import NavigationParameters

BEACONS = {"cyan/yellow": (2.9, 0.5), "yellow/cyan": (-2.9, 0.0)}
EXTENDED, PAPER = NavigationParameters.extended(), NavigationParameters.paper()
P_STEP = EXTENDED.gaze.step


def planner(limits, p=EXTENDED, mode=None):
    if mode is not None:
        p = replace(p, gaze=replace(p.gaze, mode=mode))
    return GazePlanner(p, limits, BEACONS, (1.5, 1.22), (3.0, 40.0))


@pytest.mark.parametrize("mode", ["risk", "integrated"])
def test_an_urgent_obstacle_is_looked_at(mode, belief, task, track, limits):
    side = track((0.3, 0.6), (-0.05, -0.1), sigma=0.08, age=1.0)
    decision = planner(limits, mode=mode).choose(belief([side]), task(), None)
    assert abs(decision.pan - np.arctan2(0.6, 0.3)) < 0.5 * 1.5 + P_STEP
    assert decision.pan > 0.3
    assert decision.gaze_map.max() > 0.0
    assert 0.0 <= decision.psi_ob <= 1.0


def test_a_lost_mover_is_searched_for(belief, task, track, limits):
    cloud = ([[0.0, -0.8], [0.1, -0.9]], np.zeros((2, 2)), [0.5, 0.5])
    lost = track((0, -0.8), (0.1, 0), age=2.0, particles=cloud)
    assert planner(limits).choose(belief([lost]), task(), None).pan < -0.6


def test_a_voting_gaze_decides_after_arrival_only(belief, task, track, limits, view):
    gaze = planner(limits, PAPER)
    left, right = track((0.3, 0.6), (-0.1, 0), age=1.0), track((0.3, -0.6), (-0.1, 0), age=1.0)
    first = gaze.choose(belief([left]), task(), None)
    on_the_way = gaze.choose(belief([right], time=0.06), task(), None)
    assert on_the_way.pan == first.pan
    there = view(first.pan, first.tilt)
    gaze.choose(belief([right], time=0.12, camera=there), task(), None)
    later = gaze.choose(belief([right], time=0.24, camera=there), task(), None)
    assert later.pan < 0.0 < first.pan


def test_equal_votes_do_not_make_the_gaze_chatter(belief, task, track, limits, view):
    gaze = planner(limits, mode="integrated")
    both = [track((0.0, y), (-0.05, 0), age=1.0) for y in (0.7, -0.7)]
    first = gaze.choose(belief(both), task(), None)
    for k in range(1, 100):
        camera = view(first.pan, first.tilt)
        assert (
            gaze.choose(belief(both, time=0.12 * k, camera=camera), task(), None).pan == first.pan
        )


def test_a_lost_robot_searches(belief, task, limits, view):
    gaze, pans = planner(limits), [0.0]
    for k in range(20):
        lost = belief(lost=True, time=0.06 * k, camera=view(pans[-1], -0.45))
        pans.append(gaze.choose(lost, task(), None).pan)
    assert max(pans) > 1.0
    assert min(pans) < -1.0


@pytest.mark.parametrize("p", [EXTENDED, PAPER], ids=["extended", "paper"])
def test_an_uncertain_robot_raises_its_gaze_to_a_beacon(p, belief, task, limits):
    sure = planner(limits, p).choose(belief(sigma=0.0, turn_sigma=0.0), task(), None)
    unsure = planner(limits, p).choose(belief(sigma=0.2), task(), None)
    assert unsure.tilt >= sure.tilt
    assert unsure.psi_sf > sure.psi_sf == 0.0
    assert unsure.gaze_map.max() > sure.gaze_map.max()


def test_the_order_of_tracks_is_irrelevant(belief, task, track, limits):
    rng = np.random.default_rng(3)
    for p in (EXTENDED, PAPER):
        tracks = [
            track(c, (0.1, 0), age=1.0, id=i) for i, c in enumerate(rng.uniform(-1.5, 1.5, (7, 2)))
        ]
        one = planner(limits, p).choose(belief(tracks), task(), None)
        other = planner(limits, p).choose(belief(tracks[::-1]), task(), None)
        assert (one.pan, one.tilt) == (other.pan, other.tilt)
        assert one.gaze_map == pytest.approx(other.gaze_map)


def with_a_fixed_camera(p=EXTENDED):
    return replace(p, gaze=replace(p.gaze, moved_by="body", max_pan=1.0, fixed_tilt=-0.4))


def test_a_body_turns_to_what_its_fixed_camera_must_see(belief, task, track, limits):
    gaze = planner(limits, with_a_fixed_camera())
    side = track((0.3, 0.6), (-0.05, -0.1), sigma=0.08, age=1.0)
    decision = gaze.choose(belief([side]), task(), None)
    assert decision.tilt == -0.4
    assert 0.3 < decision.pan <= 1.0
    assert decision.body_direction == pytest.approx(decision.pan)


def test_a_direction_of_the_body_stays_in_the_world_while_it_turns(belief, task, track, limits):
    gaze = planner(limits, with_a_fixed_camera())
    side = track((0.3, 0.6), (-0.05, -0.1), sigma=0.08, age=1.0)
    first = gaze.choose(belief([side]), task(), None)
    turned = gaze.choose(belief([side], pose=(0.0, 0.0, 0.2), time=0.06), task(), None)
    assert turned.body_direction == first.body_direction


def test_a_head_leaves_the_body_alone(belief, task, limits):
    assert planner(limits).choose(belief(), task(), None).body_direction is None


LEFT, AHEAD = (1.0, -0.4), (0.0, -0.4)


def timing(**parameters):
    values = {
        "dwell": 0.1,
        "arrival_tolerance": 0.05,
        "max_saccade_time": 0.6,
        "max_turn_time": 1.5,
    }
    return GazeTiming(GazeParameters(**values, **parameters))


def test_a_decision_waits_for_arrival_and_dwell():
    gaze = timing()
    gaze.decided(0.0, LEFT)
    assert not gaze.ready(0.06, 0.6)
    assert not gaze.ready(0.12, 0.02)
    assert not gaze.ready(0.18, 0.0)
    assert gaze.ready(0.24, 0.0)


def test_a_gaze_that_stays_is_decided_again_at_every_frame():
    gaze = timing()
    gaze.decided(0.0, AHEAD)
    gaze.ready(0.06, 0.0)
    assert gaze.ready(0.18, 0.0)
    gaze.decided(0.18, AHEAD)
    assert gaze.ready(0.24, 0.0)


def test_a_head_that_never_arrives_does_not_block():
    gaze = timing()
    gaze.decided(0.0, LEFT)
    assert not gaze.ready(0.5, 0.8)
    assert gaze.ready(0.6, 0.8)
