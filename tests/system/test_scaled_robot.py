"""Robots of other sizes walk in full physics without a change of code."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics, assemble
from tests.system.scaled_model import scaled_robot
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.constants import parameters_for
from walking.dimension import HSR_VIII, scale_parameters
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, WalkingParameters

EMPTY = Layout((4.0, 4.0), (), (), (0.0, 0.0, 0.0), np.zeros((0, 2)), None, endless=False)
SILENT = SensorNoise(**dict.fromkeys(SensorNoise.__dataclass_fields__, 0.0))


class Body:
    """A scaled robot on a plain floor; its sensors are perfect."""

    def __init__(self, size, folder):
        loaded = scaled_robot(size, folder)
        self.robot = loaded.model
        model = assemble(loaded, EMPTY, "vision", Optics())
        self.body = PhysicsBody(model, loaded, EMPTY, SILENT, np.random.default_rng(0))
        self.data = self.body.data
        self.sense, self.apply = self.body.sense, self.body.apply

    @property
    def tilt(self):
        _, x, y, _ = self.data.qpos[3:7].tolist()
        return np.arccos(1.0 - 2.0 * (x * x + y * y))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with the files of the robots, each of which is loaded once."""
    return tmp_path_factory.mktemp("robots")


def walk(size, folder, command, seconds, change=lambda parameters: parameters):
    """Walk with lengths in units of the size, and times in units of its square root."""
    body = Body(size, folder)
    robot = body.robot
    engine = WalkingEngine(robot, change(parameters_for(robot)))
    scaled, tilt = scale_parameters(command, HSR_VIII, robot.measures()), 0.0
    for _ in range(round(seconds * sqrt(size) / CONTROL_PERIOD)):
        body.apply(engine.step(body.sense(), scaled, HeadTarget()))
        tilt = max(tilt, body.tilt)
    return body.data.qpos[:2] / size, tilt, engine.state().step_count


@pytest.mark.parametrize(
    ("size", "command"),
    [
        (0.8, VelocityCommand(0.2, 0.04, 0.3)),
        (1.3, CommandState(forward=0.05, direction=0.1)),
    ],
)
def test_the_walk_is_the_same_in_longer_steps_and_slower_time(folder, size, command):
    position, _, steps = walk(1.0, folder, command, 2.4)
    scaled_position, tilt, scaled_steps = walk(size, folder, command, 2.4)
    assert np.hypot(*position) > 0.2
    np.testing.assert_allclose(scaled_position, position, atol=0.01)
    assert abs(scaled_steps - steps) <= 1
    assert tilt < np.radians(3.0)


@pytest.mark.parametrize("generator", ["preview", "mwpg"])
def test_every_generator_walks_a_robot_of_half_the_size(folder, generator):
    def change(parameters):
        return replace(parameters, pattern=replace(parameters.pattern, generator=generator))

    position, tilt, steps = walk(0.5, folder, VelocityCommand(0.2), 2.4, change)
    assert tilt < np.radians(3.0)
    assert steps > 3
    assert position[0] > 0.2


def test_a_small_robot_needs_parameters_of_its_own(folder):
    # Everything is chosen, nothing derived: the walk of the reference with legs too short for it.
    body = Body(0.5, folder)
    engine = WalkingEngine(body.robot, WalkingParameters())
    tilt = 0.0
    for _ in range(400):
        body.apply(engine.step(body.sense(), VelocityCommand(0.2), HeadTarget()))
        tilt = max(tilt, body.tilt)
    assert tilt > np.radians(30.0)
