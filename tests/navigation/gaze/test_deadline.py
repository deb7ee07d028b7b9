from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.gaze.deadline import (
    deadline_votes,
    look_request_vote,
    map_deadlines,
    obstacle_deadlines,
    self_urgency,
)
from navigation.gaze.scene import gaze_scene
from navigation.parameters.gaze import DeadlineParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints

P = NavigationParameters.extended()
SAMPLES = SamplePoints.polar(NavigationParameters.paper().evaluation, np.pi / 2)


def scene_of(b):
    return gaze_scene(b, None, SAMPLES, np.zeros((0, 2)), P)


def votes(b, path=0.0):
    return obstacle_deadlines(scene_of(b), path, 0.2, P)


def value(b, path=0.0):
    (v,) = votes(b, path).value
    return v


def test_a_vote_grows_with_age_up_to_its_limit(belief, track):
    values = [value(belief([track((1, 0), (-0.05, 0), age=a)])) for a in (0, 0.5, 1, 2, 9)]
    assert np.all(np.diff(values) >= 0)
    assert values[0] < 0.1
    assert values[-1] == pytest.approx(P.gaze.deadline.max_urgency**1.5)


def test_a_vote_is_1_at_half_the_worst_case_time_to_collision(belief, track):
    gap = 1.0 - 0.08 - P.univector.s_robot - 0.05
    time = gap / (0.05 + 0.5 * 0.01 + 0.2)
    age = 0.5 * time - 0.1
    assert value(belief([track((1, 0), (-0.05, 0), age=age)])) == pytest.approx(1.0)


def test_near_before_far_and_on_the_path_before_sideways(belief, track):
    def v(point, path=0.0):
        return value(belief([track(point, (-0.05, 0), age=0.3)]), path)

    assert v((0.6, 0)) > v((1.2, 0))
    assert v((1, 0)) > v((0, 1))
    assert v((0, 1), path=np.pi / 2) == pytest.approx(v((1, 0)))


def test_undecided_before_mover_before_static(belief, track):
    v = [value(belief([track((1, 0), (0.0, 0.05), m, age=0.3)])) for m in Motion]
    by = dict(zip(Motion, v, strict=True))
    assert by[Motion.UNKNOWN] > by[Motion.MOVING] > by[Motion.STATIC]


def test_new_undecided_tracks_get_a_bonus_until_they_have_enough_detections(belief, track):
    few, enough = P.gaze.deadline.fresh_hits - 1, P.gaze.deadline.fresh_hits

    def v(motion, hits):
        return value(belief([track((1.5, 0), (0.0, 0.05), motion, age=0.1, hits=hits)]))

    assert v(Motion.UNKNOWN, few) > v(Motion.UNKNOWN, enough)
    for known in (Motion.MOVING, Motion.STATIC):
        assert v(known, few) == v(known, enough)


def test_beyond_the_attention_range_only_new_tracks_vote(belief, track):
    far = P.evaluation.attention_range + 0.5
    hits = (P.gaze.deadline.fresh_hits - 1, P.gaze.deadline.fresh_hits)
    new, known = (belief([track((far, 0), (0, 0), Motion.UNKNOWN, hits=n)]) for n in hits)
    assert len(votes(new).value) == 1
    assert len(votes(known).value) == 0


def test_a_lost_mover_votes_at_its_particles(belief, track):
    cloud = ([[1, 0.5], [1, -0.5], [-3, 0]], np.zeros((3, 2)), [0.5, 0.3, 0.2])
    v = votes(belief([track((1, 0), (0.1, 0), age=3.0, particles=cloud)]))
    assert v.pan == pytest.approx([np.arctan2(0.5, 1), -np.arctan2(0.5, 1)])
    assert v.value[0] / v.value[1] == pytest.approx(0.5 / 0.3)


def test_votes_are_not_clipped_to_the_pan_limit(belief, track):
    angle = np.radians(115)
    v = votes(belief([track((np.cos(angle), np.sin(angle)), (0.0, -0.1))]))
    assert v.pan == pytest.approx([angle])
    assert len(votes(belief([track((-1, 0.1), (0.1, 0))])).pan) == 0


def test_fresh_ground_does_not_vote_and_old_ground_does(belief):
    b = belief(age=lambda x, y: 3.0 if y > 0 else 0.0)
    v = map_deadlines(scene_of(b), 0.0, 0.2, P)
    assert np.all(v.value[v.pan < -0.01] == 0.0)
    assert np.all(v.value[v.pan > 0.01] > 0.0)
    never = belief(age=lambda x, y: np.inf)
    assert np.isfinite(map_deadlines(scene_of(never), 0.0, 0.2, P).value).all()


def test_ground_votes_on_its_rings_within_the_reach_of_the_gaze(belief):
    p = replace(
        P, gaze=replace(P.gaze, deadline=DeadlineParameters(map_rings=(2.0, 0.4), map_rays=5))
    )
    b = belief()
    scene = scene_of(b)
    v = map_deadlines(scene, 0.0, 0.2, p)
    reach = P.gaze.max_pan + P.gaze.box_fraction * b.view.horizontal_fov
    assert v.pan == pytest.approx(np.tile(np.linspace(-reach, reach, 5), 2))
    assert scene.camera_height / np.tan(-v.tilt) == pytest.approx(np.repeat([2.0, 0.4], 5))


def test_self_urgency_depends_on_position_and_heading(belief):
    assert self_urgency(belief(sigma=0.025, turn_sigma=0.0), P) == pytest.approx(0.5)
    assert self_urgency(belief(sigma=0.0, turn_sigma=0.03), P) == pytest.approx(0.5)
    assert self_urgency(belief(sigma=1.0), P) == 1.0


def test_a_look_request_votes_within_the_reach_of_the_gaze(belief):
    reach = P.gaze.max_pan + P.gaze.box_fraction * belief().view.horizontal_fov
    for heading in (0.0, 2.0, -3.0):
        b = belief(pose=(1.0, 0.0, heading))
        for bearing in np.linspace(-3.1, 3.1, 41):
            votes = look_request_vote(b, heading + bearing, P.gaze)
            assert len(votes) == (abs(bearing) <= reach)
            for vote in votes:
                assert vote.value.tolist() == [P.gaze.deadline.look_request_weight]
                assert (
                    abs(vote.pan[0] - bearing) <= P.gaze.box_fraction * b.view.horizontal_fov + 1e-9
                )


@pytest.mark.parametrize("turn", [0.8, -0.8])
def test_a_turning_body_votes_for_tracks_that_come_into_reach(belief, track, turn):
    def pans(bearing, rate):
        point = (np.cos(bearing), np.sin(bearing))
        b = belief([track(point, (0.05, 0.0), age=3.0)], age=lambda x, y: 0.0)
        v = deadline_votes(scene_of(b), 0.0, 0.2, P, turn_rate=rate)
        return v.pan[v.value > P.gaze.deadline.path_weight]

    reach = P.gaze.max_pan + P.gaze.box_fraction * belief().view.horizontal_fov
    behind = np.copysign(reach + 0.1, turn)
    assert len(pans(behind, 0.0)) == 0
    assert len(pans(-behind, turn)) == 0
    (pan,) = pans(behind, turn)
    assert abs(pan) < abs(behind)


def test_a_look_request_is_one_more_vote(belief):
    without, with_one = (
        deadline_votes(scene_of(belief()), 0.0, 0.2, P, look_request=g) for g in (None, 2.0)
    )
    assert len(with_one.value) == len(without.value) + 1
