from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.gaze.scene import gaze_scene
from navigation.gaze.urgency import obstacle_urgency, urgency_votes
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints

P = NavigationParameters.extended()
SAMPLES = SamplePoints.polar(P.evaluation, np.pi / 2)
NO_BEACONS = np.zeros((0, 2))


def urgency(b, path=0.0):
    return obstacle_urgency(gaze_scene(b, None, SAMPLES, NO_BEACONS, P), path, 0.2, P)


def test_urgency_grows_with_age_and_nearness_up_to_its_limit(belief, track):
    ages = [urgency(belief([track((1, 0), (0.1, 0), age=a)]))[0] for a in (0.0, 1.0, 2.0)]
    assert np.all(np.diff(ages) > 0.0)
    gap = 1.0 - 0.08 - P.univector.s_robot
    assert ages[1] == pytest.approx(1.3 * 0.3 / gap)
    near = [urgency(belief([track((d, 0), (0.1, 0), age=1.0)]))[0] for d in (1.5, 0.8, 0.3)]
    assert np.all(np.diff(near) > 0.0)
    assert urgency(belief([track((0.3, 0), (0.1, 0), age=99.0)]))[0] == P.gaze.urgency.max_urgency


def test_static_obstacles_count_little_and_undecided_ones_more(belief, track):
    still, mover = track((1, 0), age=1.0), track((1, 0), (1e-6, 0.0), age=1.0)
    undecided = track((1, 0), (1e-6, 0.0), Motion.UNKNOWN, age=1.0)
    s, m, u = urgency(belief([still, mover, undecided]))
    assert s == pytest.approx(P.gaze.urgency.static_weight * m, rel=1e-4)
    assert u > m


def test_obstacles_ahead_count_more(belief, track):
    ahead, aside = urgency(belief([track((1, 0), (0.1, 0)), track((0, 1), (0.1, 0))]))
    assert aside == pytest.approx(P.gaze.urgency.side_weight * ahead)


def test_unseen_ground_that_slows_the_robot_down_votes(belief, task):
    fresh, unseen = (
        belief(confidence=lambda x, y, c=c: c, sigma=0.0, turn_sigma=0.0) for c in (1.0, 0.0)
    )
    calm = replace(P, gaze=replace(P.gaze, w_lm=0.0, w_way=0.0, w_sf=0.0))
    for b, values in ((fresh, []), (unseen, [P.gaze.urgency.unseen_ground_weight])):
        scene = gaze_scene(b, None, SAMPLES, NO_BEACONS, calm)
        v = urgency_votes(scene, task(), 0.3, 0.2, calm)
        strong = v.value > 0.0
        assert v.value[strong].tolist() == values
        assert v.pan[strong] == pytest.approx([0.3] * len(values))
    off = replace(calm, unseen_ground=replace(calm.unseen_ground, enabled=False))
    scene = gaze_scene(unseen, None, SAMPLES, NO_BEACONS, off)
    v = urgency_votes(scene, task(), 0.3, 0.2, off)
    assert not np.any(v.value > 0.0)
