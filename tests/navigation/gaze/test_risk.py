from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.local_map import LocalMap
from navigation.belief.visibility import Viewpoint
from navigation.decision import MotionDecision
from navigation.gaze.planner import GazePlanner
from navigation.parameters.belief import LocalMapParameters
from navigation.parameters.navigation import NavigationParameters

P = NavigationParameters()
P_MAP = LocalMapParameters()
BEACONS = {"cyan/yellow": (2.9, 0.5), "yellow/cyan": (-2.9, 0.0)}
FOV, NECK = (1.05, 0.82), (3.0, 40.0)
WALK = MotionDecision(np.array([0.2, 0.0, 0.0]))


def known(p=P, path_weight=0.0):
    """Parameters without undetected obstacles, and with looks at the path on request."""
    undetected = replace(p.gaze.undetected, movers=0.0, static=0.0)
    risk = replace(p.gaze.risk, path_weight=path_weight)
    return replace(p, gaze=replace(p.gaze, undetected=undetected, risk=risk))


@pytest.fixture
def gaze_map(limits, task):
    """The gaze map of a first decision, without undetected obstacles."""

    def look(belief, motion=WALK, beacons=BEACONS, path_weight=0.0):
        gaze = GazePlanner(known(path_weight=path_weight), limits, beacons, FOV, NECK)
        return gaze.choose(belief, task(), motion).gaze_map

    return look


def test_a_known_empty_world_asks_for_nothing(belief, gaze_map):
    assert gaze_map(belief(sigma=0.0, turn_sigma=0.0)).max() == 0.0


def test_the_value_of_an_obstacle_grows_with_its_age_up_to_the_limit(belief, track, gaze_map):
    def value(age):
        return gaze_map(belief([track((0.9, 0.3), (-0.1, 0.0), age=age)])).max()

    values = [value(age) for age in (0.0, 0.5, 1.0, 2.0, 5.0, 50.0, 500.0)]
    assert values[:4] == sorted(values[:4])
    assert values[0] < values[1] < values[2]
    assert values[-1] == pytest.approx(values[-2])


def test_near_before_far_moving_before_static_undecided_before_decided(belief, track, gaze_map):
    def value(point=(0.9, 0.3), velocity=(0.0, 0.0), motion=None, hits=20):
        return gaze_map(belief([track(point, velocity, motion, age=0.3, hits=hits)])).max()

    assert value((0.8, 0.3), (-0.1, 0.0)) > value((1.3, 0.3), (-0.1, 0.0))
    assert value(velocity=(-0.1, 0.0)) > value()
    decided, undecided = value(velocity=(-0.1, 0.0)), value(motion=Motion.UNKNOWN)
    assert value(motion=Motion.UNKNOWN, hits=3) > undecided > decided
    assert value((0.9, 0.0), (-0.1, 0.0)) > 0.0
    assert value((2.6, 0.3), (-0.1, 0.0)) == 0.0


def test_a_hidden_obstacle_is_not_worth_a_look(belief, track, gaze_map):
    hidden = track((1.6, 0.0), (-0.1, 0.0), age=2.0, id=2)
    screen = track((0.7, 0.0), age=0.0, radius=0.12, id=1)
    alone, behind = gaze_map(belief([hidden])).max(), gaze_map(belief([screen, hidden])).max()
    assert behind < 0.2 * alone


def test_a_lost_mover_is_worth_looks_at_its_particles(belief, track, gaze_map, limits):
    cloud = ([[0.0, -0.8], [0.3, 0.9]], np.zeros((2, 2)), [0.8, 0.2])
    lost = track((0.0, 0.0), (0.1, 0.0), age=2.0, particles=cloud)
    values = gaze_map(belief([lost]))
    right, left = values[:, : values.shape[1] // 2].max(), values[:, values.shape[1] // 2 :].max()
    assert right > left > 0.0


def test_beacons_are_worth_a_look_while_the_pose_is_uncertain(belief, gaze_map):
    assert gaze_map(belief(sigma=0.001, turn_sigma=0.001)).max() == 0.0
    values = gaze_map(belief(sigma=0.05, turn_sigma=0.06), beacons={"a/b": (2.5, 1.5)})
    assert values.max() > 0.0
    columns = np.nonzero(values.max(axis=0))[0]
    assert columns.min() >= values.shape[1] // 2
    assert columns.max() < values.shape[1] - 1


def test_the_path_is_worth_a_look_by_the_age_of_its_ground(belief, gaze_map):
    def value(age, path_weight=0.3):
        b = belief(sigma=0.0, turn_sigma=0.0, age=lambda x, y: age)
        return gaze_map(b, path_weight=path_weight).max()

    values = [value(age) for age in (0.0, 0.5, 1.0, 2.0, np.inf)]
    assert values == sorted(values)
    assert values[0] < 0.2 * values[2]
    assert np.isfinite(values[-1])
    assert value(2.0, path_weight=0.0) == 0.0


def test_the_gaze_map_turns_with_the_world(belief, track, limits, task):
    def chosen(turn):
        c, s = np.cos(turn), np.sin(turn)
        point = np.array([[c, -s], [s, c]]) @ (0.6, 0.7)
        b = belief([track(point, age=2.0, motion=Motion.UNKNOWN)], pose=(0.0, 0.0, turn))
        gaze = GazePlanner(known(), limits, {}, FOV, NECK)
        return gaze.choose(b, task(target=(2 * c, 2 * s)), WALK)

    plain = chosen(0.0)
    for turn in (0.5, -2.0, 3.0):
        turned = chosen(turn)
        assert (turned.pan, turned.tilt) == pytest.approx((plain.pan, plain.tilt))
        assert turned.gaze_map == pytest.approx(plain.gaze_map)


def test_a_turning_body_does_not_look_where_the_neck_cannot_stay(belief, track, limits, task):
    """The head keeps its direction while the body turns, up to the limit of the neck."""
    aside = belief([track((-0.2, 0.7), (0.1, 0.0), age=2.0)])

    def extremes(turn_rate):
        gaze = GazePlanner(known(), limits, {}, FOV, NECK)
        motion = MotionDecision(np.array([0.0, 0.0, turn_rate]))
        seen = gaze.choose(aside, task(), motion).gaze_map.max(axis=0) > 0.0
        return gaze.grid.pan[seen].min(), gaze.grid.pan[seen].max()

    still = extremes(0.0)
    assert extremes(0.8) == still
    assert extremes(-0.8)[0] == still[0]
    assert extremes(-0.8)[1] < still[1] - 0.2


def test_the_gaze_stays_where_no_other_view_is_worth_the_saccade(belief, track, limits, task, view):
    gaze = GazePlanner(known(), limits, {}, FOV, NECK)
    fresh = track((0.9, 0.2), motion=Motion.UNKNOWN, hits=3, age=0.0)
    first = gaze.choose(belief([fresh]), task(), WALK)
    for k in range(1, 10):
        camera = view(first.pan, first.tilt)
        again = gaze.choose(belief([fresh], time=0.06 * k, camera=camera), task(), WALK)
        assert (again.pan, again.tilt) == (first.pan, first.tilt)


def test_ground_where_movers_may_hide_is_visited_in_turn(limits, task, view, belief):
    """Without tracks the gaze visits both sides: ground that was looked at loses its density."""
    gaze, local_map = GazePlanner(P, limits, {}, FOV, NECK), LocalMap(P_MAP, (0.0, 0.0), 0.0)
    pan, tilt, pans = 0.0, -0.5, []
    for k in range(1, 60):
        camera = view(pan, tilt, *FOV)
        viewpoint = Viewpoint.of(camera, np.zeros(3), 2.5)
        local_map.update(0.3 * k, viewpoint, (0.0, 0.0), np.zeros((0, 2)), np.zeros(0))
        seen = replace(belief(time=0.3 * k, camera=camera), local_map=local_map.snapshot())
        decision = gaze.choose(seen, task(), WALK)
        pan, tilt = decision.pan, decision.tilt
        pans.append(pan)
    assert max(pans) > 1.0
    assert min(pans) < -1.0


def test_a_fixation_lasts_for_its_minimum_duration(belief, track, limits, task, view):
    """The head arrives at the first obstacle when the other one becomes urgent."""
    gaze = GazePlanner(known(), limits, {}, FOV, NECK)
    left, right = (track((0.5, y), (-0.1, 0.0), age=2.0) for y in (0.8, -0.8))
    first = gaze.choose(belief([left], camera=view(1.4, 0.3)), task(), WALK)
    assert first.pan > 0.3
    pans = []
    for k in range(1, 6):
        camera = view(first.pan, first.tilt)
        seen = belief([right], time=0.06 * k, camera=camera)
        pans.append(gaze.choose(seen, task(), WALK).pan)
    assert pans[0] == first.pan
    assert pans[1] < 0.0
