"""Quaternions to roll, pitch and yaw."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.rotation import roll_pitch_yaw


def quaternion(roll, pitch, yaw):
    cr, sr = cos(0.5 * roll), sin(0.5 * roll)
    cp, sp = cos(0.5 * pitch), sin(0.5 * pitch)
    cy, sy = cos(0.5 * yaw), sin(0.5 * yaw)
    return (
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    )


@given(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0))
def test_round_trip(roll, pitch, yaw):
    assert roll_pitch_yaw(quaternion(roll, pitch, yaw)) == pytest.approx(
        (roll, pitch, yaw), abs=1e-6
    )


def test_both_signs_of_a_quaternion_mean_the_same():
    q = quaternion(0.1, -0.2, 2.0)
    assert roll_pitch_yaw(tuple(-v for v in q)) == pytest.approx(roll_pitch_yaw(q))


def test_straight_up_pitch_is_a_right_angle():
    assert roll_pitch_yaw(quaternion(0.0, 0.5 * pi, 0.0))[1] == pytest.approx(0.5 * pi)
