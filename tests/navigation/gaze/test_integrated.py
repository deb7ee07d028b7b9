"""Scene of a gaze decision, and its votes."""

import numpy as np
import pytest

from navigation.gaze.integrated import integrated_votes
from navigation.gaze.planner import GazePlanner
from navigation.gaze.scene import gaze_scene, relative
from navigation.motion.planner import Planner
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints
from navigation.transform import points_to_world

PAPER, EXTENDED = NavigationParameters.paper(), NavigationParameters.extended()
SAMPLES = SamplePoints.polar(NavigationParameters.paper().evaluation, np.pi / 2)
NO_BEACONS = np.zeros((0, 2))


def votes(b, t, p=PAPER, beacons=NO_BEACONS):
    return integrated_votes(gaze_scene(b, None, SAMPLES, beacons, p), t, p)


def test_without_obstacles_waypoint_and_map_vote(belief, task):
    v = votes(belief(sigma=0.0), task((2.0, 2.0)))
    assert v.pan == pytest.approx([np.pi / 4])
    assert v.value == pytest.approx([PAPER.gaze.w_way])
    v = votes(belief(sigma=0.0, confidence=lambda x, y: float(y < 0.0)), task())
    assert v.pan[0] > 0.3
    assert v.value[0] == pytest.approx(PAPER.gaze.w_lm)


def test_stale_ground_on_both_sides_votes_ahead_in_paper_and_sideways_in_extended(belief, task):
    b = belief(sigma=0.0, confidence=lambda x, y: float(abs(y) < 0.5))
    assert abs(votes(b, task()).pan[0]) < 0.05
    v = votes(b, task(), EXTENDED)
    sides = v.pan[:-1]
    assert np.abs(sides).min() > 0.3
    assert v.value[:-1].sum() <= EXTENDED.gaze.w_lm + 1e-12


def test_printed_votes_of_obstacles_are_a_mean_and_extended_a_sum(belief, task, track):
    places = [(0.6, 0.1 * i) for i in range(4)]
    tracks = [track(x, (-0.1, 0.0), sigma=0.2, id=i) for i, x in enumerate(places)]
    b = belief(tracks, sigma=0.0)
    members = slice(-4, None)
    paper = votes(b, task())
    assert paper.value[1:5] == pytest.approx(PAPER.gaze.w_ob / 4)
    assert votes(b, task(), EXTENDED).value[members] == pytest.approx(EXTENDED.gaze.w_ob)


def test_beacons_share_the_vote_of_self_localization(belief, task):
    b = belief(sigma=0.2)
    v = votes(b, task(), EXTENDED, np.array([[2.0, 0.5], [2.0, -0.5]]))
    assert v.value[-2:] == pytest.approx(EXTENDED.gaze.w_sf / 2)
    assert v.tilt[-2:] == pytest.approx(0.0)


def test_obstacles_out_of_reach_do_not_vote(belief, task, track):
    behind = track((-1.0, 0.05), (0.3, 0.0), sigma=0.2)
    assert len(votes(belief([behind], sigma=0.0), task()).pan) == 1


def test_obstacles_and_beacons_together_do_not_exceed_one(belief, task, track, view, limits):
    """Everything at its largest and in one line of sight."""
    gaze = GazePlanner(PAPER, limits, {}, (1.6, 2.0), (3.0, 40.0))
    mover = track((2.2, 0.0), (-0.2, 0.0), sigma=1.0)
    b = belief([mover], sigma=0.2, confidence=lambda x, y: 0.0, camera=view(1.57, -0.44))
    v = votes(b, task(), beacons=np.array([[4.0, 0.0]]))
    assert v.value.sum() == pytest.approx(1.0)
    assert gaze.grid.gaze_map(v).max() == pytest.approx(1.0)


P = NavigationParameters.extended()
BEACONS = np.array([[2.9, 0.0], [-2.9, 0.0], [9.0, 0.0]])


def scene(belief_, motion=None):
    return gaze_scene(belief_, motion, SAMPLES, BEACONS, P)


def test_relative_undoes_points_to_world():
    rng = np.random.default_rng(0)
    pose, points = np.array([1.0, -0.5, 2.0]), rng.normal(size=(40, 2))
    bearing, distance = relative(points_to_world(pose, points), pose)
    back = distance[:, None] * np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
    assert back == pytest.approx(points)


def test_an_empty_fresh_world_asks_for_nothing(belief):
    s = scene(belief(sigma=0.0, turn_sigma=0.0))
    assert (s.map.psi, s.psi_sf, s.psi_ob_max, s.psi_way) == (0.0, 0.0, 0.0, 1.0)


def test_beacons_out_of_range_or_reach_are_dropped(belief):
    assert scene(belief()).beacon_bearing == pytest.approx([0.0])


def test_psi_way_falls_before_an_obstacle_and_psi_ob_rises(belief, track, task, limits):
    far = scene(belief([track((1.5, 0), sigma=0.05)]))
    b = belief([track((0.5, 0), sigma=0.05)])
    near = scene(b, Planner(P, limits).plan(belief(), task()))
    assert near.psi_way < far.psi_way == 1.0
    assert near.psi_ob_max > far.psi_ob_max == 0.0


def test_ground_in_view_is_not_counted(belief, view):
    unseen = belief(confidence=lambda x, y: 0.0, camera=view(0.6, -0.5))
    s = scene(unseen)
    left = s.samples.bearing > 0.05
    assert s.map.counted[~left].sum() > s.map.counted[left].sum()
