"""Dead reckoning by the feet."""

from math import cos, pi, sin

import pytest

from walking.odometry import LegOdometry


def feet_in_body(body, feet):
    x, y, yaw = body
    c, s = cos(yaw), sin(yaw)
    return tuple((c * (fx - x) + s * (fy - y), c * (fy - y) - s * (fx - x)) for fx, fy in feet)


def test_a_body_over_fixed_feet_is_followed_exactly():
    odometry = LegOdometry()
    feet = ((0.0, 0.04), (0.02, -0.04))
    for k in range(200):
        body = (0.01 * sin(0.1 * k), 0.02 * cos(0.05 * k) - 0.02, 0.3 * sin(0.02 * k))
        odometry.update(body[2], feet_in_body(body, feet), (k % 10) / 10.0)
    pose = odometry.pose()
    assert (pose.x, pose.y, pose.yaw) == pytest.approx(body, abs=1e-12)


def test_a_foot_without_load_may_move_as_it_likes():
    odometry = LegOdometry()
    for k in range(50):
        body = (0.001 * k, 0.0, 0.0)
        odometry.update(0.0, feet_in_body(body, ((0.0, 0.04), (0.01 * k, -0.3))), 0.0)
    assert odometry.x == pytest.approx(0.049)
    assert odometry.y == pytest.approx(0.0)


def test_heading_is_unwrapped_and_starts_at_zero():
    odometry = LegOdometry()
    for k in range(100):
        yaw = (2.0 + 0.1 * k + pi) % (2.0 * pi) - pi
        odometry.update(yaw, ((0.0, 0.04), (0.0, -0.04)), 0.5)
    assert odometry.yaw == pytest.approx(9.9)
