from dataclasses import replace

import numpy as np
import pytest

from navigation.belief import Motion
from navigation.deadline_gaze import (
    map_deadlines,
    obstacle_deadlines,
    reachable_share,
    self_urgency,
)
from navigation.decision_parameters import NavigationParameters
from navigation.gaze_scene import gaze_scene
from navigation.partial_evaluation import SamplePoints

P = NavigationParameters.extended()
SAMPLES = SamplePoints.polar(NavigationParameters.paper().evaluation, np.pi / 2)


def votes(b, way=0.0):
    scene = gaze_scene(b, None, SAMPLES, np.zeros((0, 2)), P)
    return obstacle_deadlines(scene, b, way, 0.2, P)


def value(b, way=0.0):
    (v,) = votes(b, way).value
    return v


def test_a_vote_grows_with_age_up_to_its_limit(belief, track):
    values = [value(belief([track((1, 0), (-0.05, 0), age=a)])) for a in (0, 0.5, 1, 2, 9)]
    assert np.all(np.diff(values) >= 0)
    assert values[0] < 0.1
    assert values[-1] == pytest.approx(P.gaze.deadline.urgency_limit**1.5)


def test_it_is_1_at_half_the_worst_case_time_to_contact(belief, track):
    gap = 1.0 - 0.08 - P.univector.s_robot - 0.05
    contact = gap / (0.05 + 0.5 * 0.01 + 0.2)
    age = 0.5 * contact - 0.1
    assert value(belief([track((1, 0), (-0.05, 0), age=age)])) == pytest.approx(1.0)


def test_near_before_far_and_on_the_way_before_beside(belief, track):
    def v(place, way=0.0):
        return value(belief([track(place, (-0.05, 0), age=0.3)]), way)

    assert v((0.6, 0)) > v((1.2, 0))
    assert v((1, 0)) > v((0, 1))
    assert v((0, 1), way=np.pi / 2) == pytest.approx(v((1, 0)))


def test_undecided_before_mover_before_static(belief, track):
    v = [value(belief([track((1, 0), (0.0, 0.05), m, age=0.3)])) for m in Motion]
    by = dict(zip(Motion, v, strict=True))
    assert by[Motion.UNKNOWN] > by[Motion.MOVING] > by[Motion.STATIC]


def test_a_lost_mover_votes_where_it_may_be(belief, track):
    cloud = ([[1, 0.5], [1, -0.5], [-3, 0]], np.zeros((3, 2)), [0.5, 0.3, 0.2])
    v = votes(belief([track((1, 0), (0.1, 0), age=3.0, particles=cloud)]))
    assert v.pan == pytest.approx([np.arctan2(0.5, 1), -np.arctan2(0.5, 1)])
    assert v.value[0] / v.value[1] == pytest.approx(0.5 / 0.3)


def test_votes_are_not_clipped_to_the_pan_stop(belief, track):
    angle = np.radians(115)
    v = votes(belief([track((np.cos(angle), np.sin(angle)), (0.0, -0.1))]))
    assert v.pan == pytest.approx([angle])
    assert len(votes(belief([track((-1, 0.1), (0.1, 0))])).pan) == 0


def test_fresh_ground_does_not_vote_and_old_ground_does(belief):
    b = belief(age=lambda x, y: 3.0 if y > 0 else 0.0)
    scene = gaze_scene(b, None, SAMPLES, np.zeros((0, 2)), P)
    v = map_deadlines(scene, b, 0.0, 0.2, P)
    assert np.all(v.value[v.pan < -0.01] == 0.0)
    assert np.all(v.value[v.pan > 0.01] > 0.0)
    never = belief(age=lambda x, y: np.inf)
    assert np.isfinite(map_deadlines(scene, never, 0.0, 0.2, P).value).all()


def test_mirror_symmetry(belief, track):
    left = votes(belief([track((1, 0.4), (-0.1, 0.05), age=0.5)]), 0.3)
    right = votes(belief([track((1, -0.4), (-0.1, -0.05), age=0.5)]), -0.3)
    assert left.pan == pytest.approx(-right.pan)
    assert left.value == pytest.approx(right.value)


def test_self_urgency_hears_position_and_heading(belief):
    assert self_urgency(belief(sigma=0.025, turn_sigma=0.0), P) == pytest.approx(0.5)
    assert self_urgency(belief(sigma=0.0, turn_sigma=0.03), P) == pytest.approx(0.5)
    assert self_urgency(belief(sigma=1.0), P) == 1.0


def lost(track, reach, place=(0.0, -0.6), motion=None):
    cloud = ([place, place], np.zeros((2, 2)), [0.5, 0.5])
    return track(place, (0.1, 0.0), motion, age=2.0, particles=cloud, reach=reach)


def test_a_lost_mover_is_shared_among_the_unseen_points_it_can_have_reached(belief, track):
    points = np.random.default_rng(0).uniform(-1.5, 1.5, (200, 2))
    age = np.where(points[:, 0] > 0.0, 3.0, 0.0)
    share = reachable_share(points, age, belief([lost(track, 0.7)]))
    assert share.sum() == pytest.approx(1.0)
    inside = (np.hypot(*(points - [0.0, -0.6]).T) <= 0.7) & (age > 0.0)
    np.testing.assert_array_equal(share > 0.0, inside)
    both = belief([lost(track, 0.7), lost(track, 0.5, (0.8, 0.5))])
    assert reachable_share(points, age, both).sum() == pytest.approx(2.0)


def test_only_lost_movers_can_be_elsewhere(belief, track):
    points, age = np.zeros((1, 2)), np.ones(1)
    seen = track((0.1, 0.0), (0.1, 0.0), reach=1.0)
    still = lost(track, 1.0, motion=Motion.STATIC)
    assert reachable_share(points, age, belief([seen, still])) == pytest.approx([0.0])


def test_ground_that_a_lost_mover_can_have_reached_is_looked_at(belief, track):
    p = replace(P, gaze=replace(P.gaze, deadline=replace(P.gaze.deadline, reach_weight=1.0)))
    b = belief([lost(track, 0.8)], age=lambda x, y: 2.0)
    scene = gaze_scene(b, None, SAMPLES, np.zeros((0, 2)), p)
    with_reach, without = map_deadlines(scene, b, 0.0, 0.2, p), map_deadlines(scene, b, 0.0, 0.2, P)
    more = with_reach.value - without.value
    assert more[with_reach.pan > 0.5].max() == 0.0
    assert more.max() > 0.0
