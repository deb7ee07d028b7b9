from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.local_map import LocalMap
from navigation.belief.visibility import Viewpoint
from navigation.decision import MotionDecision
from navigation.parameters.belief import LocalMapParameters
from navigation.parameters.navigation import NavigationParameters

P = NavigationParameters()
P_MAP = LocalMapParameters()
BEACONS = {"cyan/yellow": (2.9, 0.5), "yellow/cyan": (-2.9, 0.0)}
FOV = (1.05, 0.82)
WALK = MotionDecision(np.array([0.2, 0.0, 0.0]))


def known(p=P, path_weight=0.0):
    """Parameters without undetected obstacles, and with looks at the path on request."""
    undetected = replace(p.gaze.undetected, movers=0.0, static=0.0)
    risk = replace(p.gaze.risk, path_weight=path_weight)
    return replace(p, gaze=replace(p.gaze, undetected=undetected, risk=risk))


@pytest.fixture
def gaze_map(gaze):
    """The gaze map of a first decision, without undetected obstacles."""

    def look(belief, motion=WALK, beacons=BEACONS, path_weight=0.0):
        return gaze(known(path_weight=path_weight), beacons)(belief, motion=motion).gaze_map

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


def test_a_view_of_a_beacon_shows_its_seam_and_nothing_hides_it(belief, track, gaze):
    """Its top may be above the image."""

    def worth(*tracks):
        choose = gaze(known(), {"a/b": (1.2, 0.0)})
        b = belief(tracks, sigma=0.05, turn_sigma=0.06)
        values, grid = choose(b).gaze_map, choose.planner.grid
        ahead = values[:, int(np.abs(grid.pan).argmin())]
        seam = np.arctan2(0.3 - b.view.position[2], 1.2 - b.view.position[0])
        return np.abs(grid.tilt - seam) / (0.5 * b.view.vertical_fov), ahead

    off, alone = worth()
    assert (alone[off > 1.0] == 0.0).all()
    assert (alone[off < 0.85] > 0.0).all()
    _, behind = worth(track((0.7, 0.0), (0.0, 0.0), age=0.0, radius=0.12, id=1))
    assert (behind >= alone).all()


def test_the_path_is_worth_a_look_by_the_age_of_its_ground(belief, gaze_map):
    def value(age, path_weight=0.3):
        b = belief(sigma=0.0, turn_sigma=0.0, age=lambda x, y: age)
        return gaze_map(b, path_weight=path_weight).max()

    values = [value(age) for age in (0.0, 0.5, 1.0, 2.0, np.inf)]
    assert values == sorted(values)
    assert values[0] < 0.2 * values[2]
    assert np.isfinite(values[-1])
    assert value(2.0, path_weight=0.0) == 0.0


def test_the_gaze_map_turns_with_the_world(belief, track, gaze):
    def chosen(turn):
        c, s = np.cos(turn), np.sin(turn)
        point = np.array([[c, -s], [s, c]]) @ (0.6, 0.7)
        b = belief([track(point, age=2.0, motion=Motion.UNKNOWN)], pose=(0.0, 0.0, turn))
        return gaze(known(), {})(b, (2 * c, 2 * s), WALK)

    plain = chosen(0.0)
    for turn in (0.5, -2.0, 3.0):
        turned = chosen(turn)
        assert (turned.pan, turned.tilt) == pytest.approx((plain.pan, plain.tilt))
        assert turned.gaze_map == pytest.approx(plain.gaze_map)


def test_a_turning_body_does_not_look_where_the_neck_cannot_stay(belief, track, gaze):
    """The head keeps its direction while the body turns, up to the limit of the neck."""
    aside = belief([track((-0.2, 0.7), (0.1, 0.0), age=2.0)])

    def extremes(turn_rate):
        choose = gaze(known(), {})
        motion = MotionDecision(np.array([0.0, 0.0, turn_rate]))
        seen = choose(aside, motion=motion).gaze_map.max(axis=0) > 0.0
        return choose.planner.grid.pan[seen].min(), choose.planner.grid.pan[seen].max()

    still = extremes(0.0)
    assert extremes(0.8) == still
    assert extremes(-0.8)[0] == still[0]
    assert extremes(-0.8)[1] < still[1] - 0.2


def test_the_gaze_stays_where_no_other_view_is_worth_the_saccade(belief, track, gaze, view):
    choose = gaze(known(), {})
    fresh = track((0.9, 0.2), motion=Motion.UNKNOWN, hits=3, age=0.0)
    first = choose(belief([fresh]), motion=WALK)
    for k in range(1, 10):
        camera = view(first.pan, first.tilt)
        again = choose(belief([fresh], time=0.06 * k, camera=camera), motion=WALK)
        assert (again.pan, again.tilt) == (first.pan, first.tilt)


@pytest.fixture
def look_around(belief, view):
    """Lets a gaze look at an empty world from a pose for a number of frames; returns the pans."""

    def look(choose, pose=(0.0, 0.0, 0.0), frames=60):
        local_map, decision, pans = LocalMap(P_MAP, pose[:2], 0.0), None, []
        for k in range(1, frames):
            pan, tilt = (0.0, -0.5) if decision is None else (decision.pan, decision.tilt)
            camera = view(pan, tilt, *FOV)
            viewpoint = Viewpoint.of(camera, np.array(pose), 2.5)
            local_map.update(0.3 * k, viewpoint, pose[:2], np.zeros((0, 2)), np.zeros(0))
            b = belief(time=0.3 * k, camera=camera, pose=pose)
            decision = choose(replace(b, local_map=local_map.snapshot()), motion=WALK)
            pans.append(decision.pan)
        return pans

    return look


def test_ground_where_movers_may_hide_is_visited_in_turn(gaze, look_around):
    """Without tracks the gaze visits both sides: ground that was looked at loses its density."""
    pans = look_around(gaze(beacons={}))
    assert max(pans) > 1.0
    assert min(pans) < -1.0


def test_a_fixation_lasts_for_its_minimum_duration(belief, track, gaze, view):
    """The head arrives at the first obstacle when the other one becomes urgent."""
    choose = gaze(known(), {})
    left, right = (track((0.5, y), (-0.1, 0.0), age=2.0) for y in (0.8, -0.8))
    first = choose(belief([left], camera=view(1.4, 0.3)), motion=WALK)
    assert first.pan > 0.3
    pans = []
    for k in range(1, 6):
        camera = view(first.pan, first.tilt)
        seen = belief([right], time=0.06 * k, camera=camera)
        pans.append(choose(seen, motion=WALK).pan)
    assert pans[0] == first.pan
    assert pans[1] < 0.0
