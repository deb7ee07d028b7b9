from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.visibility import Viewpoint, clear_points
from navigation.motion.unseen_ground import ground_points, ground_seen
from navigation.parameters.motion import UnseenGroundParameters

P = UnseenGroundParameters()


def test_the_points_lie_ahead_of_the_motion_in_any_frame(rotation):
    here = ground_points(np.zeros(3), 0.0, P)
    assert len(here) == 12
    assert here[:, 0].min() == pytest.approx(P.near)
    assert here[:, 0].max() == pytest.approx(P.far)
    assert np.abs(here[:, 1]).max() == pytest.approx(P.half_width)
    a, shift = 0.7, np.array([1.0, -2.0])
    there = ground_points(np.array([*shift, 3.0]), a, P)
    assert there == pytest.approx(here @ rotation(a).T + shift)


def test_a_look_20_deg_down_shows_all_checked_ground(view):
    pose = np.array([1.0, -0.5, 0.7])
    eye = Viewpoint.of(view(tilt=-np.radians(20.0)), pose, 3.0)
    for near, shown in ((P.near, True), (0.25, False)):
        points = ground_points(pose, pose[2], replace(P, near=near))
        visible = clear_points(points, *eye, np.zeros((0, 2)), np.zeros(0))
        assert visible.all() == shown


def test_ground_is_seen_if_every_point_was_seen(belief):
    b = belief(pose=(0.0, 0.0, 2.0), confidence=lambda x, y: P.confidence - 1e-9 * (y > 0.05))
    assert ground_seen(b, -0.5 * np.pi, P)
    assert not ground_seen(b, 0.0, P)
    assert not ground_seen(b, 0.5 * np.pi, P)
