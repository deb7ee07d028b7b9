from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.visibility import Viewpoint, clear_points
from navigation.gaze.risk import ground_points
from navigation.parameters.gaze import GroundAheadParameters

P = GroundAheadParameters()


def test_the_points_lie_ahead_of_the_motion_in_any_frame(rotation):
    here = ground_points(np.zeros(3), 0.0, P)
    assert len(here) == 3 * P.rows
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
