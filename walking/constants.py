"""Constants of a walk: records of the robot and its joints, from model and parameters."""

from math import cosh, sinh

import numpy as np

from walking.balance import ankle_gain
from walking.body.robot_model import RobotModel
from walking.estimation import steady_gains
from walking.footsteps import STILL, velocity_strides
from walking.parameters import CONTROL_PERIOD, GRAVITY, LIGHT_LOAD, WalkingParameters
from walking.patterns import preview_gains
from walking.pendulum import natural_frequency
from walking.records import JOINT, PREVIEW_SUM, Record, parameters_record
from walking.swing_reaction import leg_reaction

LEGS = slice(0, 12)  # joints


def robot_record(robot: RobotModel, parameters: WalkingParameters) -> tuple[Record, Record]:
    """Return the constants of a robot (1,), and the sums of the gains of preview control.

    Args:
        robot: model of the robot.
        parameters: parameters of its walk.
    """
    records = parameters_record(parameters)
    r, p, leg = records[0], parameters, robot.legs[0]
    r.omega = omega = natural_frequency(p.pattern.lipm_height)
    r.cosh, r.sinh = cosh(omega * CONTROL_PERIOD), sinh(omega * CONTROL_PERIOD)
    r.weight, r.leg_length = robot.mass * GRAVITY, leg.length
    r.light_load = LIGHT_LOAD * robot.mass * GRAVITY
    for sole, rectangle in ((r.sole, robot.sole), (r.support, robot.support)):
        sole.centre = rectangle.centre
        sole.half_length, sole.half_width = rectangle.half_length, rectangle.half_width
    r.com_ahead = float(robot.com(robot.ready)[0])
    r.height = p.pattern.pelvis_height - leg.hip[2]
    r.chains, r.reach = robot.chains, [leg.reach for leg in robot.legs]
    r.ankle, r.stiffening = leg.ankle, robot.stiffening
    r.shoulders, r.shoulder_signs = robot.tree.shoulders or (-1, -1), robot.shoulder_signs()
    robot.neck.describe(r.neck)
    reaction = leg_reaction(robot, float(r.height), p.gait.swing_height)
    r.thrust, r.lifted_weight, r.knee = reaction.thrust, reaction.weight, reaction.knee
    r.position_gain, r.velocity_gain = steady_gains(omega, p.estimator)
    ankles = slice(leg.ankle, 6)
    lag = float((robot.damping[ankles] / robot.stiffness[ankles]).max())
    r.ankle_gain = ankle_gain(omega, lag, p.stabilizer.dcm_rate)
    sums = np.zeros(1, PREVIEW_SUM)
    if p.pattern.generator == "preview":
        gains = preview_gains(omega, p.pattern)
        r.preview_position, r.preview_velocity = gains.position, gains.velocity
        r.preview_zmp, r.preview_total, sums = gains.zmp, gains.total, gains.sums
    velocity_strides(r.still, STILL, p.gait.footstep_time, r)
    return records, sums


def joint_records(robot: RobotModel, parameters: WalkingParameters) -> Record:
    """Return the joints of a robot (n,)."""
    p = parameters.stabilizer
    joints = np.zeros(robot.ready.size, JOINT)
    gain = np.full(robot.ready.size, p.upper_velocity_gain)
    gain[LEGS] = p.velocity_gain
    joints["lower"], joints["upper"], joints["ready"] = robot.lower, robot.upper, robot.ready
    joints["load_gain"] = p.load_gain / robot.stiffness
    joints["lag"] = gain * robot.damping / robot.stiffness
    joints["compliance"] = 1.0 / robot.stiffness
    joints["in_q"], joints["in_v"] = robot.indices
    return joints
