"""Lying side and rest from a synthetic IMU."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from walking.get_up import Lying, RestDetector, lying_on, up_in_trunk
from walking.parameters import GetUpParameters

ANGLE = st.floats(-pi, pi)


def quaternion(yaw, pitch, roll):
    x, y, z, w = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat().tolist()
    return w, x, y, z


@given(ANGLE, st.floats(-1.5, 1.5), ANGLE)
def test_the_vertical_is_the_one_that_the_rotation_gives(yaw, pitch, roll):
    expected = Rotation.from_euler("ZYX", [yaw, pitch, roll]).inv().apply([0.0, 0.0, 1.0])
    assert up_in_trunk(quaternion(yaw, pitch, roll)) == pytest.approx(expected, abs=1e-12)


@given(ANGLE, st.floats(-0.6, 0.6))
def test_the_lying_side_is_independent_of_the_heading(yaw, tilt):
    right = 0.5 * pi
    for side, pitch, roll in (
        (Lying.FRONT, right + tilt, 0.0),
        (Lying.BACK, tilt - right, 0.0),
        (Lying.LEFT, tilt, -right),
        (Lying.RIGHT, tilt, right),
    ):
        assert lying_on(up_in_trunk(quaternion(yaw, pitch, roll))) is side


@given(st.floats(0.0, 2.0 * pi))
def test_the_mirror_swaps_left_and_right_alone(angle):
    forward, left = cos(angle), sin(angle)
    swapped = {Lying.LEFT: Lying.RIGHT, Lying.RIGHT: Lying.LEFT}
    side, mirrored = lying_on((forward, left, 0.0)), lying_on((forward, -left, 0.0))
    assert mirrored is swapped.get(side, side)


def test_rest_needs_its_duration_and_restarts_after_a_jolt():
    parameters = GetUpParameters(rest_rate=0.3, rest_time=0.05)
    rest = RestDetector(parameters)
    slow, fast = (0.2, -0.2, 0.1), (0.0, 0.0, -0.4)
    assert [rest.update(slow) for _ in range(11)] == [False] * 9 + [True] * 2
    assert not rest.update(fast)
    assert [rest.update(slow) for _ in range(10)] == [False] * 9 + [True]
