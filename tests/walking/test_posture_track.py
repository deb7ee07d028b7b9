"""Set-points from posture to posture."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.parameters import CONTROL_PERIOD
from walking.posture_track import PEAK, PostureTrack, minimum_jerk

SPEED = 8.0


@given(st.floats(0.0, 1.0))
def test_minimum_jerk_is_symmetric_in_time(share):
    assert minimum_jerk(share) + minimum_jerk(1.0 - share) == pytest.approx(1.0)


def test_minimum_jerk_starts_and_ends_at_rest_and_peaks_in_the_middle():
    shares = np.linspace(0.0, 1.0, 2001)
    way = np.array([minimum_jerk(s) for s in shares])
    speed, force = np.gradient(way, shares), np.gradient(np.gradient(way, shares), shares)
    assert way[0] == 0.0
    assert way[-1] == 1.0
    assert speed.max() == pytest.approx(PEAK, rel=1e-4)
    assert abs(speed[[0, -1]]).max() < 1e-4
    assert abs(force[[0, -1]]).max() < 0.1


def test_outside_its_time_minimum_jerk_stays_where_it_is():
    assert minimum_jerk(-1.0) == 0.0
    assert minimum_jerk(2.0) == 1.0


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 2.0))
def test_set_points_keep_the_limits_of_angle_and_speed(robot, seed, time):
    rng = np.random.default_rng(seed)
    track = PostureTrack(robot, SPEED, robot.ready)
    before = track.angles
    for _ in range(3):
        track.aim(rng.uniform(-4.0, 4.0, 26), time)
        for _ in range(rng.integers(1, 200)):
            angles = track.advance()
            assert (angles > robot.lower - 1e-12).all()
            assert (angles < robot.upper + 1e-12).all()
            assert np.abs(angles - before).max() <= SPEED * CONTROL_PERIOD * (1.0 + 1e-9)
            before = angles


def test_it_arrives_in_time_and_holds(robot):
    goal = 0.5 * (robot.ready + np.clip(np.zeros(26), robot.lower, robot.upper))
    track = PostureTrack(robot, SPEED, robot.ready)
    track.aim(goal, 0.5, 0.1)
    way = []
    while not track.done:
        way.append(track.advance())
    assert len(way) == 120
    assert way[99] == pytest.approx(goal)
    assert way[-1] == pytest.approx(goal)
