"""Warm-up: run the engine for a few steps so that every kernel is compiled."""

from dataclasses import replace

import numpy as np

from walking.body.robot_model import RobotModel
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.sensing import BodySensors

START_TIME = 0.03  # double support before the first footstep [s]
TICKS = 20  # enough for a double and a single support


def warm_up(robot: RobotModel, parameters: WalkingParameters) -> None:
    """Compile or load every kernel that a control tick calls; the robot does not move."""
    at_once = replace(parameters.gait, settle_time=0.0, start_time=START_TIME)
    engine = WalkingEngine(robot, replace(parameters, gait=at_once))
    sensors = BodySensors(
        joint_position=robot.ready,
        joint_velocity=np.zeros_like(robot.ready),
        gyro=np.zeros(3),
        accelerometer=np.array([0.0, 0.0, GRAVITY]),
        orientation=np.array([1.0, 0.0, 0.0, 0.0]),
        foot_force=np.full((2, 4), robot.mass * GRAVITY / 8.0),
    )
    forward = VelocityCommand(parameters.limits.forward_acceleration * CONTROL_PERIOD)
    for _ in range(TICKS):
        engine.step(sensors, forward, HeadTarget())
    engine.step(sensors, CommandState(), HeadTarget())
    engine.state()
