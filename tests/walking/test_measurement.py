"""Sensors in the level frame of the heading."""

from dataclasses import replace

import numpy as np
import pytest

from walking.measurement import measure
from walking.state import Footstep
from walking.swing import FootReference


def test_a_tilted_body_over_flat_feet_is_seen_level(robot, ideal_body):
    sensors = ideal_body.sense()
    level = measure(robot, sensors, 0.0, 0.0, 0.0)
    pitch = 0.1
    tilted = measure(robot, sensors, 0.0, pitch, 0.0)
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
    body = measure(robot, replace(sensors, foot_force=force), 0.0, 0.0, 0.0)
    assert body.right_load == 1.0
    airborne = measure(robot, replace(sensors, foot_force=np.zeros((2, 4))), 0.0, 0.0, 0.0)
    assert airborne.right_load == 0.5


def test_the_centre_of_pressure_is_under_the_loaded_corner_and_between_loaded_feet(
    robot, ideal_body
):
    sensors, sole = ideal_body.sense(), robot.sole
    feet = tuple(FootReference(Footstep(side == 0, 0.1 * side, 0.0, 0.3)) for side in (0, 1))
    force = np.zeros((2, 4))
    force[0, 1] = 10.0
    body = measure(robot, replace(sensors, foot_force=force), 0.0, 0.0, 0.0)
    corner = np.array([sole.centre + sole.half_length, -sole.half_width])
    assert body.feet[0].pressure == pytest.approx(tuple(corner))
    R = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    assert body.pressure(feet) == pytest.approx(tuple(R @ corner))
    force[1, 1] = 10.0
    body = measure(robot, replace(sensors, foot_force=force), 0.0, 0.0, 0.0)
    assert body.pressure(feet) == pytest.approx(tuple(R @ corner + [0.05, 0.0]))
    airborne = measure(robot, replace(sensors, foot_force=np.zeros((2, 4))), 0.0, 0.0, 0.0)
    assert airborne.pressure(feet) is None
