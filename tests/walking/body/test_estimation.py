"""Sensors in the level frame of the heading, and the body against the plan."""

from dataclasses import replace

import numpy as np
import pytest

from walking.body.estimation import Estimation
from walking.body.odometry import LegOdometry
from walking.parameters import WalkingParameters

PARAMETERS = WalkingParameters()
STILL = (0.0,) * 11


def estimation(robot):
    return Estimation(robot, 7.2, PARAMETERS.estimator, LegOdometry(PARAMETERS.odometry))


def observed(robot, sensors, **changes):
    estimate = estimation(robot)
    estimate.observe(replace(sensors, **changes))
    return estimate.body


def pressure(robot, sensors, force, feet):
    estimate = estimation(robot)
    estimate.update(replace(sensors, foot_force=force), feet, STILL, stepping=False)
    return estimate.pressure_error


def test_a_tilted_body_over_flat_feet_is_seen_level(robot, ideal_body):
    sensors = ideal_body.sense()
    level = observed(robot, sensors)
    pitched = np.array([np.cos(0.05), 0.0, np.sin(0.05), 0.0])
    tilted = observed(robot, sensors, orientation=pitched)
    assert (tilted.roll, tilted.pitch) == pytest.approx((0.0, 0.1))
    # Pitching forward carries the mass centre ahead of the feet.
    assert tilted.com[0] - tilted.feet[0].x > level.com[0] - level.feet[0].x + 0.01
    arm = np.hypot(level.com[0] - level.feet[0].x, level.com[2] - level.feet[0].z)
    assert np.hypot(
        tilted.com[0] - tilted.feet[0].x, tilted.com[2] - tilted.feet[0].z
    ) == pytest.approx(arm)


def test_light_pad_noise_is_no_load(robot, ideal_body):
    sensors = ideal_body.sense()
    force = np.zeros((2, 4))
    force[1] = 12.0
    force[0, 0] = 0.8
    estimate = estimation(robot)
    estimate.observe(replace(sensors, foot_force=force))
    assert estimate.body.right_load == 1.0
    assert (estimate.load(0), estimate.load(1)) == pytest.approx((0.8, 48.0))
    assert observed(robot, sensors, foot_force=np.zeros((2, 4))).right_load == 0.5


def test_the_centre_of_pressure_is_under_the_loaded_corner_and_between_loaded_feet(
    robot, ideal_body
):
    sensors, sole = ideal_body.sense(), robot.sole
    feet = np.array([[0.0, 0.0, 0.3, 0.0], [0.1, 0.0, 0.3, 0.0]])
    force = np.zeros((2, 4))
    force[0, 1] = 10.0
    corner = np.array([sole.centre + sole.half_length, -sole.half_width])
    R = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    assert pressure(robot, sensors, force, feet) == pytest.approx(tuple(R @ corner))
    force[1, 1] = 10.0
    both = pressure(robot, sensors, force, feet)
    assert both == pytest.approx(tuple(R @ corner + [0.05, 0.0]))
    assert pressure(robot, sensors, np.zeros((2, 4)), feet) == (0.0, 0.0)


def test_observing_leaves_odometry_and_error_alone(robot, ideal_body):
    estimate, sensors = estimation(robot), ideal_body.sense()
    feet = np.array([[0.0, 0.042, 0.0, 0.0], [0.0, -0.042, 0.0, 0.0]])
    estimate.update(sensors, feet, STILL, stepping=False)
    pose, error = estimate.pose, estimate.com_error
    moved = replace(sensors, joint_position=sensors.joint_position + 0.1)
    estimate.observe(moved)
    assert (estimate.pose, estimate.com_error) == (pose, error)
    assert estimate.body.com != observed(robot, sensors).com


def test_weight_going_over_to_a_foot_is_no_motion_of_the_body(robot, ideal_body):
    """Seen from a foot half a centimetre off its position, the body is off by as much, at once."""
    estimate, sensors = estimation(robot), ideal_body.sense()
    estimate.observe(sensors)
    body = estimate.body
    feet = np.array([(foot.x, foot.y, foot.yaw, 0.0) for foot in body.feet])
    feet[1, 0] += 0.005
    planned = (0.0, 0.0, 0.0, *body.com[:2], *(0.0,) * 5)
    estimate.update(sensors, feet, (*planned, 0.0), stepping=True)
    assert estimate.com_error == pytest.approx((0.0, 0.0, 0.0, 0.0), abs=1e-12)
    estimate.update(sensors, feet, (*planned, 1.0), stepping=True)
    assert estimate.com_error[:2] == pytest.approx((0.005, 0.0), abs=1e-5)
    assert abs(estimate.com_error[2]) < 0.01


@pytest.mark.parametrize("right", [0.0, 0.3, 1.0])
def test_a_body_as_planned_has_no_error_wherever_the_plan_is_and_however_it_is_turned(
    robot, ideal_body, right
):
    estimate, sensors = estimation(robot), ideal_body.sense()
    estimate.observe(sensors)
    body = estimate.body
    at, turn, yaw = np.array([0.3, -0.2]), 0.7, -0.4  # of the level frame; yaw of the plan

    def turned(angle, point):
        c, s = np.cos(angle), np.sin(angle)
        return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])

    feet = np.array([(*(at + turned(turn, (f.x, f.y))), turn + f.yaw, 0.0) for f in body.feet])
    origin = np.array([0.11, 0.07])
    planned = turned(-yaw, at + turned(turn, body.com[:2]) - origin)
    for off in ((0.0, 0.0), (0.004, -0.003)):
        estimate = estimation(robot)
        plan = (*origin, yaw, *(planned - off), *(0.0,) * 5, right)
        for _ in range(300):
            estimate.update(sensors, feet, plan, stepping=True)
        # A steady error: what pushes the body away is held by nothing, so it shows as a rate too.
        error = estimate.com_error
        assert error[:2] == pytest.approx(tuple(turned(yaw, off)), abs=3e-4)
