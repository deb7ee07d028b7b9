"""A robot model and a body without dynamics."""

from math import atan2, cos, sin
from typing import Any, NamedTuple

import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from walking.body.robot_model import RobotModel
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.constants import robot_record
from walking.data import Data
from walking.model import Strides
from walking.parameters import CONTROL_PERIOD, PatternParameters, WalkingParameters
from walking.plan.footsteps import STILL, Foothold, put, velocity_strides
from walking.plan.gait import stand
from walking.plan.swing import rest_at
from walking.plan.timing import cadence, put_timing
from walking.state import BodySensors


@pytest.fixture(scope="session")
def robot() -> RobotModel:
    return load_robot("hsr8").model


class IdealBody:
    """Joints follow their targets exactly; the lower foot stays where it stands."""

    def __init__(self, robot, stance=0):
        self._robot = robot
        self._joints = robot.ready.copy()
        self._before = self._joints
        self.x = self.y = self.yaw = 0.0
        self._turn = 0.0
        self._stance = stance
        self._anchor = self._foot_in_world(stance)

    def sense(self):
        feet = self._feet()
        gap = feet[1 - self._stance].z - feet[self._stance].z
        force = np.zeros((2, 4))
        fraction = 0.5 if gap < 1e-3 else 0.0
        force[self._stance] = (1.0 - fraction) * self._robot.mass * 9.81 / 4.0
        force[1 - self._stance] = fraction * self._robot.mass * 9.81 / 4.0
        return BodySensors(
            joint_position=self._joints,
            joint_velocity=(self._joints - self._before) / CONTROL_PERIOD,
            gyro=np.array([0.0, 0.0, self._turn]),
            accelerometer=np.array([0.0, 0.0, 9.81]),
            orientation=np.array([cos(0.5 * self.yaw), 0.0, 0.0, sin(0.5 * self.yaw)]),
            foot_force=force,
        )

    def apply(self, targets):
        self._before, self._joints = self._joints, targets.position
        feet = self._feet()
        self._stand()
        other = 1 - self._stance
        if feet[other].z < feet[self._stance].z - 1e-9:
            self._anchor = self._foot_in_world(other)
            self._stance = other

    def _stand(self):
        foot = self._feet()[self._stance]
        ax, ay, a_yaw = self._anchor
        before, yaw = self.yaw, a_yaw - foot.yaw
        self._turn = atan2(sin(yaw - before), cos(yaw - before)) / CONTROL_PERIOD
        self.yaw = yaw
        self.x = ax - cos(yaw) * foot.x + sin(yaw) * foot.y
        self.y = ay - sin(yaw) * foot.x - cos(yaw) * foot.y

    def _feet(self):
        return [
            leg.pose(self._joints[part])
            for leg, part in zip(self._robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True)
        ]

    def _foot_in_world(self, side):
        foot = self._feet()[side]
        c, s = cos(self.yaw), sin(self.yaw)
        return (
            self.x + c * foot.x - s * foot.y,
            self.y + s * foot.x + c * foot.y,
            self.yaw + foot.yaw,
        )


@pytest.fixture(scope="session")
def make_body(robot):
    return lambda stance=0: IdealBody(robot, stance)


@pytest.fixture
def ideal_body(make_body) -> IdealBody:
    return make_body()


@pytest.fixture(scope="session")
def mirrored_joints(robot):
    """Mirrors angles of all joints (..., n) at the sagittal plane."""
    names = robot.names
    swapped = [
        names.index({"l": "r", "r": "l"}[name[0]] + name[1:] if name[:2] in ("l_", "r_") else name)
        for name in names
    ]
    sign = np.array(
        [-1.0 if name.endswith(("yaw", "roll", "pan", "gripper")) else 1.0 for name in names]
    )
    return lambda angles: sign * angles[..., swapped]


class Model(NamedTuple):
    """Constants of a walk."""

    robot: Any


@pytest.fixture(scope="session")
def make_model(robot):
    """Constants of a walk with a pattern generator."""

    def make(generator="preview", parameters=None):
        parameters = parameters or WalkingParameters(pattern=PatternParameters(generator=generator))
        return Model(robot_record(robot, parameters)[0])

    return make


@pytest.fixture(scope="session")
def model(make_model):
    return make_model()


@pytest.fixture(scope="session")
def strides_of(model):
    """Strides of a velocity in the usual time."""

    def make(velocity, time=None):
        strides = np.zeros(1, Strides)[0]
        time = time or model.robot.gait.footstep_time
        velocity_strides(strides, velocity, time, model.robot)
        return strides

    return make


@pytest.fixture
def make_walk(model):
    """State of a walk that stands with parallel feet."""

    def make(stance=None):
        half = float(model.robot.gait.half_stance)
        stance = stance or (Foothold(True, 0.0, half, 0.0), Foothold(False, 0.0, -half, 0.0))
        walk = np.zeros(1, Data)[0]
        gait = walk.plan.gait
        for side, foot in enumerate(stance):
            put(gait.footholds[side], foot)
            rest_at(walk.limbs.feet[side], foot)
        for timing in (gait.clock.timing, walk.steering.timing):
            put_timing(timing, cadence(STILL, model.robot))
        stand(gait, model.robot)
        walk.admission.clock, walk.plan.steps[0] = gait.clock, gait.landing
        walk.admission.fraction = 1.0
        return walk

    return make
