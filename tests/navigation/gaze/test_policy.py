from dataclasses import replace
from typing import get_args

import numpy as np
import pytest

from navigation.gaze.choice import BLIND, VotingGaze
from navigation.gaze.gaze_map import GazeGrid, Votes
from navigation.gaze.planner import GazePlanner
from navigation.parameters.gaze import GazeMode, GazeParameters
from navigation.parameters.navigation import NavigationParameters

BEACONS = {"cyan/yellow": (2.9, 0.5), "yellow/cyan": (-2.9, 0.0), "magenta/cyan": (0.5, 2.9)}
P = NavigationParameters.extended()
MODES = get_args(GazeMode)
DELIBERATE = [mode for mode in MODES if mode not in BLIND]
FOV, NECK = (1.5, 1.22), (3.0, 40.0)


def planner(limits, mode, step=P.gaze.step):
    gaze = replace(P.gaze, mode=mode, step=step)
    return GazePlanner(replace(P, gaze=gaze), limits, BEACONS, FOV, NECK)


@pytest.fixture
def choose(limits, task):
    def choose(mode, belief, **where):
        step = P.gaze.step / 2.0
        return planner(limits, mode, step).choose(belief, task(**where), None)

    return choose


ODD = {"step": 0.13, "max_pan": 1.5, "min_tilt": -1.0, "max_tilt": 0.27}


@pytest.mark.parametrize("changes", [{}, ODD], ids=["default", "no multiple of the step"])
@pytest.mark.parametrize("mode", MODES)
def test_every_gaze_stays_within_the_limits_of_the_head(mode, changes, limits, task, belief, track):
    p = replace(P.gaze, mode=mode, **changes)
    rng = np.random.default_rng(1)
    for k in range(12):
        tracks = [track(c, (0.1, 0.0), age=1.0) for c in rng.uniform(-1.5, 1.5, (5, 2))]
        b = belief(tracks, time=0.37 * k, confidence=lambda x, y: 0.5)
        gaze = GazePlanner(replace(P, gaze=p), limits, BEACONS, FOV, NECK).choose(b, task(), None)
        assert abs(gaze.pan) <= p.max_pan + 1e-9
        assert p.min_tilt - 1e-9 <= gaze.tilt <= p.max_tilt + 1e-9
        assert np.isfinite(gaze.gaze_map).all()
        assert gaze.gaze_map.min() >= 0.0


@pytest.mark.parametrize("ratio", [1.0, 1.1])
def test_at_a_ratio_of_one_the_gaze_is_the_centre_of_the_plateau_and_stays(ratio):
    p = GazeParameters(max_pan=1.0, min_tilt=-1.0, max_tilt=0.0, step=0.1, box_fraction=0.5)
    grid = GazeGrid(p, 0.8, 0.6)
    gaze = VotingGaze(lambda context: Votes.one(0.2, -0.5, 1.0), grid, ratio)
    now = (0.5, -0.4)
    for _ in range(5):
        now = gaze.look(None, now)[1]
    assert now == pytest.approx((0.2, -0.5) if ratio == 1.0 else (0.5, -0.4))


@pytest.mark.parametrize("mode", DELIBERATE)
def test_the_mirror_image_of_a_world_is_looked_at_from_the_other_side(
    mode, choose, belief, track, limits, task
):
    def world(side):
        tracks = [track((0.4, 0.8 * side), (-0.05, -0.1 * side), sigma=0.1, age=1.5)]
        unseen = belief(tracks, confidence=lambda x, y: 0.2 if side * y > 0 else 1.0)
        beacons = {"cyan/yellow": (0.5, 2.9 * side)}
        p = replace(P, gaze=replace(P.gaze, mode=mode))
        goal = task(target=(0.2, 2.0 * side))
        return GazePlanner(p, limits, beacons, FOV, NECK).choose(unseen, goal, None)

    left, right = world(1.0), world(-1.0)
    assert left.pan > 0.1
    assert right.pan == pytest.approx(-left.pan, abs=P.gaze.step + 1e-9)
    assert right.gaze_map == pytest.approx(left.gaze_map[:, ::-1])


def test_a_single_evaluation_votes_alone(choose, belief, track):
    blind = belief(sigma=0.0, turn_sigma=0.0)
    assert choose("psi-lm", blind).gaze_map.max() == 0.0
    assert choose("psi-sf", blind).gaze_map.max() == 0.0
    assert choose("psi-ob", blind).gaze_map.max() == 0.0
    unseen = belief(sigma=0.0, turn_sigma=0.0, confidence=lambda x, y: float(y < 0))
    assert choose("psi-lm", unseen).pan > 0.2
    lateral = belief([track((0.3, -0.6), (0.0, 0.1), sigma=0.1)], sigma=0.0, turn_sigma=0.0)
    assert choose("psi-ob", lateral).pan < -0.2
    assert choose("psi-way", lateral, target=(0.0, 2.0)).pan > 0.5
    assert choose("psi-sf", belief(sigma=0.3)).gaze_map.max() == pytest.approx(1.0)


@pytest.mark.parametrize("mode", MODES)
def test_deliberate_gazes_and_stops_keep_their_direction_while_the_body_turns(
    mode, choose, belief, track
):
    decision = choose(mode, belief([track((0.5, 0.5), age=1.0)]))
    assert decision.stabilized == (mode not in ("fixed", "sweep", "triangle"))
