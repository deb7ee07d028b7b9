"""Saccade and dwell, the search of a lost robot, and bodies that turn their camera."""

import numpy as np
import pytest

from navigation.parameters.navigation import NavigationParameters

EXTENDED, PAPER = NavigationParameters.extended(), NavigationParameters.paper()
P_STEP = EXTENDED.gaze.step


@pytest.mark.parametrize("mode", ["risk", "integrated"])
def test_an_urgent_obstacle_is_looked_at(mode, gaze, belief, track):
    side = track((0.3, 0.6), (-0.05, -0.1), sigma=0.08, age=1.0)
    decision = gaze(mode=mode)(belief([side]))
    assert abs(decision.pan - np.arctan2(0.6, 0.3)) < 0.5 * 1.5 + P_STEP
    assert decision.pan > 0.3
    assert decision.gaze_map.max() > 0.0
    assert 0.0 <= decision.psi_ob <= 1.0


def test_a_lost_mover_is_searched_for(gaze, belief, track):
    cloud = ([[0.0, -0.8], [0.1, -0.9]], np.zeros((2, 2)), [0.5, 0.5])
    lost = track((0, -0.8), (0.1, 0), age=2.0, particles=cloud)
    assert gaze()(belief([lost])).pan < -0.6


def test_a_steady_gaze_decides_after_arrival_and_dwell_only(gaze, belief, track, view):
    choose = gaze(PAPER)
    left, right = track((0.3, 0.6), (-0.1, 0), age=1.0), track((0.3, -0.6), (-0.1, 0), age=1.0)
    first = choose(belief([left]))
    there = view(first.pan, first.tilt)
    waiting = [
        choose(belief([right], time=0.06)),
        choose(belief([right], time=0.12, camera=there)),
        choose(belief([right], time=0.18, camera=there)),
    ]
    assert [decision.pan for decision in waiting] == [first.pan] * 3
    later = choose(belief([right], time=0.24, camera=there))
    assert later.pan < 0.0 < first.pan


@pytest.mark.parametrize("time", [0.5, 0.6])
def test_a_head_that_never_arrives_does_not_block(time, gaze, belief, track, view):
    choose = gaze(PAPER)
    left, right = track((0.3, 0.6), (-0.1, 0), age=1.0), track((0.3, -0.6), (-0.1, 0), age=1.0)
    first = choose(belief([left]))
    later = choose(belief([right], time=time, camera=view(0.0, 0.0)))
    assert (later.pan != first.pan) == (time >= PAPER.gaze.max_saccade_time)


def test_equal_votes_do_not_make_the_gaze_chatter(gaze, belief, track, view):
    choose = gaze(mode="integrated")
    both = [track((0.0, y), (-0.05, 0), age=1.0) for y in (0.7, -0.7)]
    first = choose(belief(both))
    for k in range(1, 100):
        camera = view(first.pan, first.tilt)
        assert choose(belief(both, time=0.12 * k, camera=camera)).pan == first.pan


def test_a_lost_robot_searches(gaze, belief, view):
    choose, pans = gaze(), [0.0]
    for k in range(20):
        lost = belief(lost=True, time=0.06 * k, camera=view(pans[-1], -0.45))
        pans.append(choose(lost).pan)
    assert max(pans) > 1.0
    assert min(pans) < -1.0


@pytest.mark.parametrize("p", [EXTENDED, PAPER], ids=["extended", "paper"])
def test_an_uncertain_robot_raises_its_gaze_to_a_beacon(p, gaze, belief):
    sure = gaze(p)(belief(sigma=0.0, turn_sigma=0.0))
    unsure = gaze(p)(belief(sigma=0.2))
    assert unsure.tilt >= sure.tilt
    assert unsure.psi_sf > sure.psi_sf == 0.0
    assert unsure.gaze_map.max() > sure.gaze_map.max()


FIXED_CAMERA = {"moved_by": "body", "max_pan": 1.0, "fixed_tilt": -0.4}


def test_a_body_turns_to_what_its_fixed_camera_must_see(gaze, belief, track):
    side = track((0.3, 0.6), (-0.05, -0.1), sigma=0.08, age=1.0)
    decision = gaze(**FIXED_CAMERA)(belief([side]))
    assert decision.tilt == -0.4
    assert 0.3 < decision.pan <= 1.0
    assert decision.body_direction == pytest.approx(decision.pan)
