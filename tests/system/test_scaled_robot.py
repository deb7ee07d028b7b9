"""Robots of other sizes walk in full physics without a change of code."""

from dataclasses import replace
from math import sqrt

import mujoco
import numpy as np
import pytest
from scaled_model import scale_robot

from hsr8.robots.models import models_dir
from walking.body.joints import JOINT_NAMES
from walking.body.robot_model import RobotModel
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.robot_measures import HSR_VIII
from walking.scaling import parameters_for, scale_parameters
from walking.sensing import BodySensors

PADS = [f"{side}_sole_{pad}_force" for side in "lr" for pad in ("fl", "fr", "bl", "br")]


class Body:
    """A scaled robot on a plain floor; its sensors are perfect."""

    def __init__(self, size, folder):
        spec = mujoco.MjSpec.from_file(str(models_dir() / "hsr8" / "hsr8.xml"))
        scale_robot(spec, size)
        spec.compile()
        path = folder / f"robot-{size}.xml"
        path.write_text(spec.to_xml(), encoding="utf-8")
        self.robot = RobotModel.from_mjcf(path)
        floor = spec.worldbody.add_geom(
            name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], condim=4
        )
        floor.contype, floor.conaffinity = 3, 1
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        model = self.model
        mujoco.mj_resetDataKeyframe(model, self.data, model.key("walk_ready").id)
        mujoco.mj_forward(model, self.data)
        self._qpos = [int(model.joint(name).qposadr[0]) for name in JOINT_NAMES]
        self._dof = [int(model.joint(name).dofadr[0]) for name in JOINT_NAMES]
        self._servos = [model.actuator(f"{name}_act").id for name in JOINT_NAMES]
        self._pads = [int(model.sensor(name).adr[0]) for name in PADS]

    def sense(self):
        data = self.data
        return BodySensors(
            joint_position=data.qpos[self._qpos],
            joint_velocity=data.qvel[self._dof],
            gyro=data.qvel[3:6].copy(),
            accelerometer=np.array([0.0, 0.0, 9.81]),
            orientation=data.qpos[3:7].copy(),
            foot_force=data.sensordata[self._pads].reshape(2, 4),
        )

    def apply(self, targets):
        self.data.ctrl[self._servos] = targets.setpoint
        for _ in range(round(CONTROL_PERIOD / self.model.opt.timestep)):
            mujoco.mj_step(self.model, self.data)

    @property
    def tilt(self):
        _, x, y, _ = self.data.qpos[3:7].tolist()
        return np.arccos(1.0 - 2.0 * (x * x + y * y))


def walk(size, folder, command, seconds, parameters=None):
    """Walk with lengths in units of the size, and times in units of its square root."""
    body = Body(size, folder)
    robot = body.robot
    engine = WalkingEngine(robot, parameters_for(robot, parameters))
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
def test_the_walk_is_the_same_in_longer_steps_and_slower_time(tmp_path, size, command):
    position, _, steps = walk(1.0, tmp_path, command, 3.0)
    scaled_position, tilt, scaled_steps = walk(size, tmp_path, command, 3.0)
    assert np.hypot(*position) > 0.3
    np.testing.assert_allclose(scaled_position, position, atol=0.01)
    assert abs(scaled_steps - steps) <= 1
    assert tilt < np.radians(3.0)


@pytest.mark.parametrize("generator", ["preview", "paper", "robust"])
def test_every_generator_walks_a_robot_of_half_the_size(tmp_path, generator):
    pattern = replace(WalkingParameters().pattern, generator=generator)
    parameters = replace(WalkingParameters(), pattern=pattern)
    position, tilt, steps = walk(0.5, tmp_path, VelocityCommand(0.2), 2.4, parameters)
    assert tilt < np.radians(3.0)
    assert steps > 3
    assert position[0] > 0.2


def test_a_small_robot_needs_parameters_of_its_own(tmp_path):
    # Everything is chosen, nothing derived: the walk of the reference with legs too short for it.
    body = Body(0.6, tmp_path)
    engine = WalkingEngine(body.robot, WalkingParameters())
    tilt = 0.0
    for _ in range(400):
        body.apply(engine.step(body.sense(), VelocityCommand(0.2), HeadTarget()))
        tilt = max(tilt, body.tilt)
    assert tilt > np.radians(30.0)
