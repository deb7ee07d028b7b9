"""Small worlds the tests of the bodies and cameras share."""

import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.field.layout import Layout, Obstacle, standard_beacons
from hsr8.world.model.assembly import Optics, assemble

BEACONS = standard_beacons((5.0, 5.0))


@pytest.fixture
def silent():
    """No sensor noise at all."""
    return SensorNoise(**dict.fromkeys(SensorNoise.__dataclass_fields__, 0.0))


@pytest.fixture
def world():
    """Builds a layout from obstacles, and its model in the cheap quality."""

    def make(*obstacles: Obstacle, start=(0.0, 0.0, 0.0), beacons=BEACONS):
        layout = Layout(
            field_size=(5.0, 5.0),
            obstacles=obstacles,
            beacons=beacons,
            start=start,
            waypoints=np.zeros((0, 2)),
            goal_heading=None,
            endless=False,
        )
        return layout, assemble(load_robot("hsr8"), layout, "vision", Optics())

    return make


@pytest.fixture
def body(world, silent):
    """A robot that looks down a little at a red obstacle ahead."""
    layout, model = world(Obstacle((1.0, 0.2), 0.08, 0.3, "red"))
    body = KinematicBody(model, load_robot("hsr8"), layout, silent, np.random.default_rng(0))
    body.data.joint("head_tilt").qpos[0] = -0.3
    body.update_kinematics()
    return body
