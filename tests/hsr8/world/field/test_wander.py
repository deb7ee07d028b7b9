from math import hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.world.field.wander import CORNERS, MIN_BEND_RADIUS, draw_wander

EXTENT = 1.4
LAWS = [draw_wander(np.random.default_rng(k), (0.5, -0.2), EXTENT, 0.12) for k in range(12)]
laws = st.sampled_from(LAWS)
times = st.floats(0.0, 600.0)


@given(laws, times)
def test_the_speed_is_constant(motion, time):
    assert hypot(*motion.velocity(time)) == pytest.approx(0.12, rel=1e-4)


@given(laws, times)
def test_it_comes_back_after_once_round(motion, time):
    assert motion.position(time + motion.length / motion.speed) == pytest.approx(
        motion.position(time)
    )


@pytest.mark.parametrize("motion", LAWS)
def test_the_track_fills_its_box_and_no_more(motion):
    track = np.array(motion.track)
    extent = np.ptp(track, axis=0)
    assert extent.max() == pytest.approx(EXTENT, abs=0.01)
    assert 0.5 * (track.max(axis=0) + track.min(axis=0)) == pytest.approx((0.5, -0.2), abs=0.01)


@pytest.mark.parametrize("motion", LAWS)
def test_the_track_bends_gently(motion):
    sides = np.diff(np.array([*motion.track, *motion.track[:2]]), axis=0)
    heading = np.unwrap(np.arctan2(sides[:, 1], sides[:, 0]))
    turns = np.abs(np.diff(heading))
    assert len(motion.track) == CORNERS
    # The track was looked at in a few places, and a polygon turns at its corners only.
    assert turns.max() <= 1.3 * motion.side / MIN_BEND_RADIUS


def test_an_extent_too_small_for_the_bends_has_no_track():
    assert draw_wander(np.random.default_rng(0), (0.0, 0.0), 0.1, 0.1) is None
