"""Rate and acceleration of the head."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.body.posture import advance_head
from walking.command import HeadTarget
from walking.data import Limbs
from walking.observer import Head
from walking.parameters import CONTROL_PERIOD, HeadParameters, WalkingParameters

HEAD = HeadParameters(max_rate=6.0, max_acceleration=60.0)
PARAMETERS = replace(WalkingParameters(), head=HEAD)


@pytest.fixture(scope="module")
def head(make_model):
    """Constants of a robot with a fast head."""
    return make_model(parameters=PARAMETERS).robot


@pytest.fixture
def follow(head):
    """Pan and tilt tick by tick of a head that starts straight."""

    def run(targets):
        limbs = np.zeros(1, Limbs)[0]
        path = [(limbs.pan, limbs.tilt)]
        for target in targets:
            advance_head(limbs, target, head)
            path.append((limbs.pan, limbs.tilt))
        return np.array(path)

    return run


@settings(max_examples=30)
@given(
    st.lists(
        st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.integers(1, 60)),
        min_size=1,
        max_size=8,
    )
)
def test_limits_hold_for_any_targets(robot, head, moves):
    limbs = np.zeros(1, Limbs)[0]
    path = [np.zeros(2)]
    for pan, tilt, ticks in moves:
        for _ in range(ticks):
            advance_head(limbs, (pan, tilt), head)
            path.append((limbs.pan, limbs.tilt))
    rates = np.diff(path, axis=0) / CONTROL_PERIOD
    changes = np.diff(np.vstack([np.zeros(2), rates]), axis=0) / CONTROL_PERIOD
    assert np.abs(rates).max() <= HEAD.max_rate + 1e-9
    assert np.abs(changes).max() <= HEAD.max_acceleration + 1e-6
    low, high = robot.neck.range().T
    assert (np.array(path) >= low - 0.01).all()
    assert (np.array(path) <= high + 0.01).all()


def test_a_saccade_arrives_without_overshoot_in_minimum_time(follow):
    path = follow([(1.2, -0.4)] * 80)
    assert path[-1] == pytest.approx((1.2, -0.4), abs=1e-9)
    assert path[:, 0].max() <= 1.2 + 1e-9
    # Trapezoid: distance / rate + rate / acceleration.
    arrival = np.argmax(path[:, 0] > 1.2 - 1e-3) * CONTROL_PERIOD
    assert arrival == pytest.approx(1.2 / 6.0 + 6.0 / 60.0, abs=0.02)


def test_a_head_under_another_walker_turns_its_joints(robot):
    head = Head(robot, PARAMETERS)
    for _ in range(200):
        joints = head.advance(HeadTarget(0.5, -0.3))
    q = robot.ready.copy()
    q[list(robot.tree.head)] = joints
    assert robot.neck.angles(q) == pytest.approx((0.5, -0.3), abs=1e-9)
