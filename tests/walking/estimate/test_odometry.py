"""Dead reckoning by the stance foot."""

from itertools import pairwise
from math import cos, pi, sin

import numpy as np
import pytest

from walking.estimate.odometry import LegOdometry, increment, reckon
from walking.parameters import CONTROL_PERIOD, OdometryParameters

PARAMETERS = OdometryParameters()


def update(odometry, heading, feet, load, *, stepping):
    """One tick."""
    reckon(odometry.records[0], heading, feet, load, stepping)


def feet_in_body(body, feet):
    x, y, yaw = body
    c, s = cos(yaw), sin(yaw)
    return tuple((c * (fx - x) + s * (fy - y), c * (fy - y) - s * (fx - x)) for fx, fy in feet)


def test_a_body_over_fixed_feet_is_followed_exactly():
    odometry = LegOdometry(PARAMETERS)
    feet = ((0.0, 0.04), (0.02, -0.04))
    for k in range(200):
        body = (0.01 * sin(0.1 * k), 0.02 * cos(0.05 * k) - 0.02, 0.3 * sin(0.02 * k))
        update(odometry, body[2], feet_in_body(body, feet), (k % 10) / 10.0, stepping=True)
    pose = odometry.pose()
    assert (pose.x, pose.y, pose.yaw) == pytest.approx(body, abs=1e-12)


def test_heading_is_unwrapped_and_starts_at_zero():
    odometry = LegOdometry(PARAMETERS)
    for k in range(100):
        yaw = (2.0 + 0.1 * k + pi) % (2.0 * pi) - pi
        update(odometry, yaw, ((0.0, 0.04), (0.0, -0.04)), 0.5, stepping=False)
    assert odometry.pose().yaw == pytest.approx(9.9)


def driven(path, parameters=PARAMETERS, *, stepping=True):
    """Readings along poses (n, 3), both feet in the odometry frame's origin."""
    odometry = LegOdometry(parameters)
    readings = []
    for body in path:
        foot = feet_in_body(body, ((0.0, 0.0), (0.0, 0.0)))
        update(odometry, body[2], foot, 0.5, stepping=stepping)
        readings.append(odometry.pose())
    return readings


def winding(n=400):
    k = np.arange(n)
    return np.column_stack([0.004 * k, 0.3 * np.sin(0.01 * k), 0.5 * np.sin(0.02 * k)])


def test_increments_compose():
    """Covariance of a stretch is that of its parts, carried along by the motion."""
    readings = driven(winding())
    a, b, c = readings[50], readings[170], readings[390]
    first, second, both = increment(a, b), increment(b, c), increment(a, c)
    turned, (dx, dy, _) = first.motion[2], second.motion
    co, si = cos(turned), sin(turned)
    R = np.array([[co, -si, 0.0], [si, co, 0.0], [0.0, 0.0, 1.0]])
    F = np.eye(3)
    F[:2, 2] = -si * dx - co * dy, co * dx - si * dy
    assert first.motion + R @ second.motion == pytest.approx(both.motion, abs=1e-12)
    assert F @ first.covariance @ F.T + R @ second.covariance @ R.T == pytest.approx(
        both.covariance, rel=1e-9, abs=1e-18
    )


def test_covariance_is_that_of_a_walk_with_unseen_motions():
    """Monte Carlo of the model itself: unseen motions in every tick, replayed exactly."""
    parameters = OdometryParameters(forward_noise=0.004, lateral_noise=0.002, yaw_drift=0.01)
    path = winding(200)
    readings = driven(path, parameters)
    rng = np.random.default_rng(5)
    steps = np.array([increment(a, b).motion for a, b in pairwise(readings)])
    sigma = np.array([0.004, 0.002, 0.01]) * np.sqrt(CONTROL_PERIOD)
    pose = np.zeros((4000, 3))
    for step in steps:
        moved = step + sigma * rng.standard_normal(pose.shape)
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        pose += np.column_stack(
            [c * moved[:, 0] - s * moved[:, 1], s * moved[:, 0] + c * moved[:, 1], moved[:, 2]]
        )
    result = increment(readings[0], readings[-1])
    assert np.cov(pose.T) == pytest.approx(
        result.covariance, abs=0.1 * np.diag(result.covariance).max()
    )
    ratio = np.linalg.solve(result.covariance, np.cov(pose.T))
    assert np.trace(ratio) / 3.0 == pytest.approx(1.0, abs=0.08)


def test_an_interruption_keeps_the_place_and_admits_what_it_hides():
    odometry = LegOdometry(PARAMETERS)
    feet = ((0.0, 0.04), (0.02, -0.04))
    for k in range(100):
        body = (0.002 * k, 0.001 * k, 0.3)
        update(odometry, body[2] - 0.3, feet_in_body(body, feet), 0.5, stepping=True)
    before = odometry.pose()
    odometry.interrupt(0.3, 0.05)
    # It stands up elsewhere, turned by half a radian.
    elsewhere = (1.0, -2.0, 0.8)
    at_feet = feet_in_body(elsewhere, ((1.0, -1.96), (1.02, -2.04)))
    update(odometry, elsewhere[2] - 0.3, at_feet, 0.5, stepping=False)
    after = odometry.pose()
    assert (after.x, after.y) == pytest.approx((before.x, before.y))
    assert after.yaw - before.yaw == pytest.approx(0.5)
    unseen = increment(before, after).covariance
    assert np.diag(unseen) == pytest.approx([0.3**2, 0.3**2, 0.05**2], rel=1e-3)


def test_a_foot_that_slides_while_it_is_loaded_does_not_count():
    odometry = LegOdometry(PARAMETERS)
    for k in range(101):
        body, load = 0.001 * k, 0.007 * k
        slid = 0.1 + 0.0002 * k
        feet = feet_in_body((body, 0.0, 0.0), ((0.0, 0.04), (slid, -0.04)))
        update(odometry, 0.0, feet, load, stepping=True)
    assert odometry.pose().x == pytest.approx(0.1)


def stepped(slip, parameters):
    """Growth of the covariance over a double support in which the left foot slides."""
    odometry = LegOdometry(parameters)
    loads = [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0]
    for k, load in enumerate(loads):
        slid = slip * min(1.0, max(0.0, (k - 2) / 3.0))
        update(odometry, 0.0, ((slid, 0.04), (0.1, -0.04)), load, stepping=True)
        if k == 0:
            before = odometry.pose()
    return increment(before, odometry.pose()).covariance


def test_feet_that_slide_against_each_other_are_held_against_the_odometry():
    parameters = OdometryParameters(slip_ratio=0.5)
    grown = stepped(0.004, parameters) - stepped(0.0, parameters)
    assert grown[:2, :2] == pytest.approx(0.002**2 * np.eye(2), rel=1e-4, abs=1e-9)
    assert grown[2] == pytest.approx(np.zeros(3), abs=1e-9)
    drift = 6 * CONTROL_PERIOD * parameters.yaw_drift**2  # a slip is not a turn
    assert stepped(0.004, parameters)[2, 2] == pytest.approx(drift)


def test_a_foot_in_the_air_does_not_slip():
    odometry, still = LegOdometry(PARAMETERS), LegOdometry(PARAMETERS)
    for k in range(100):
        update(odometry, 0.0, ((0.0, 0.04), (0.001 * k, -0.04)), 0.1, stepping=True)
        update(still, 0.0, ((0.0, 0.04), (0.0, -0.04)), 0.1, stepping=True)
    assert odometry.pose().covariance == pytest.approx(still.pose().covariance, abs=1e-18)
