"""Constants of a walk, from model and parameters: records of the robot and of its joints."""

from dataclasses import astuple, fields
from math import cosh, sinh
from typing import Any, cast

import numpy as np

from compilation.record import Records
from walking.body.robot_model import RobotModel
from walking.body.swing_reaction import leg_reaction
from walking.dimension import HSR_VIII, scale_parameters
from walking.estimate.body import steady_gains
from walking.model import Joint, Model
from walking.parameters import CONTROL_PERIOD, GRAVITY, LIGHT_LOAD, WalkingParameters
from walking.plan.balance import ankle_gain
from walking.plan.footsteps import STILL, velocity_strides
from walking.plan.pendulum import natural_frequency

LEGS = slice(0, 12)  # joints


def parameters_for(robot: RobotModel) -> WalkingParameters:
    """Return the parameters of HSR-VIII scaled to a robot; for HSR-VIII exactly the defaults."""
    return scale_parameters(WalkingParameters(), HSR_VIII, robot.measures())


def parameters_record(parameters: WalkingParameters) -> Records[Model]:
    """Return constants of which only the parameters are set (1,)."""
    robots = np.zeros(1, Model)
    for section in fields(parameters):
        if section.name in (robots.dtype.names or ()):
            record, values = robots[section.name], getattr(parameters, section.name)
            for key in record.dtype.names or ():
                record[key] = getattr(values, key)
    robots["modifiable"] = parameters.pattern.generator == "mwpg"
    return cast("Records[Model]", robots)


def robot_record(robot: RobotModel, parameters: WalkingParameters) -> Records[Model]:
    """Return the constants of a robot (1,).

    Args:
        robot: model of the robot.
        parameters: parameters of its walk.
    """
    robots = parameters_record(parameters)
    r: Any = robots[0]
    p, leg = parameters, robot.legs[0]
    r.omega = omega = natural_frequency(p.pattern.lipm_height)
    r.cosh, r.sinh = cosh(omega * CONTROL_PERIOD), sinh(omega * CONTROL_PERIOD)
    r.weight, r.leg_length = robot.mass * GRAVITY, leg.length
    r.light_load = LIGHT_LOAD * robot.mass * GRAVITY
    r.sole, r.support = astuple(robot.sole), astuple(robot.support)
    r.com_ahead = float(robot.com(robot.ready)[0])
    r.height = p.pattern.pelvis_height - leg.hip[2]
    r.chains = [side.chain for side in robot.legs]
    r.reach = [tuple(side.reach.tolist()) for side in robot.legs]
    frames = (*robot.tree.feet, robot.tree.camera)
    r.carriers = [frame.joint for frame in frames]
    r.frames = [robot.on_link(frame) for frame in frames]
    r.ankle, r.stiffening = leg.ankle, robot.stiffening
    r.shoulders = list(zip(robot.tree.shoulders or (-1, -1), robot.shoulder_signs(), strict=True))
    robot.neck.describe(r.neck)
    r.thrust, r.lifted_weight, r.knee = leg_reaction(robot, float(r.height), p.gait.swing_height)
    r.position_gain, r.velocity_gain = steady_gains(omega, p.estimator)
    ankles = slice(leg.ankle, 6)
    lag = float((robot.damping[ankles] / robot.stiffness[ankles]).max())
    r.ankle_gain = ankle_gain(omega, lag, p.stabilizer.dcm_rate)
    velocity_strides(r.still, STILL, p.gait.footstep_time, r)
    return robots


def joint_records(robot: RobotModel, parameters: WalkingParameters) -> Records[Joint]:
    """Return the joints of a robot (n,)."""
    p = parameters.stabilizer
    joints = np.zeros(robot.ready.size, Joint)
    gain = np.ones(robot.ready.size)
    gain[LEGS] = p.velocity_gain
    joints["lower"], joints["upper"], joints["ready"] = robot.lower, robot.upper, robot.ready
    joints["lag"] = gain * robot.damping / robot.stiffness
    joints["compliance"] = 1.0 / robot.stiffness
    joints["in_q"], joints["in_v"] = robot.indices
    return cast("Records[Joint]", joints)
