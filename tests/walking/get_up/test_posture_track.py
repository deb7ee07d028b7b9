"""Setpoints from posture to posture."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.get_up import PostureTrack
from walking.parameters import CONTROL_PERIOD

SPEED = 8.0


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
    path = []
    while not track.done:
        path.append(track.advance())
    assert len(path) == 120
    assert path[99] == pytest.approx(goal)
    assert path[-1] == pytest.approx(goal)
