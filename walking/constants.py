"""Constants of a walk, from model and parameters: records of the robot and of its joints."""

from math import cosh, sinh

import numpy as np

from compilation.record import record_type
from walking.balance import ankle_gain
from walking.body.robot_model import NECK, RobotModel
from walking.dimension import HSR_VIII, override, scale_parameters
from walking.estimation import steady_gains
from walking.feedforward import JOINT
from walking.footsteps import STILL, STRIDES, velocity_strides
from walking.parameters import CONTROL_PERIOD, GRAVITY, LIGHT_LOAD, WalkingParameters
from walking.pendulum import natural_frequency
from walking.records import GENERATORS, SECTIONS, Record
from walking.swing_reaction import leg_reaction

SOLE = record_type(centre=float, half_length=float, half_width=float)
"""Rectangle of a sole in the foot frame [m]."""

ROBOT = record_type(
    # Parameters: gait, pattern, estimator, ...
    **SECTIONS,
    # Pendulum: ω [1/s], cosh and sinh of ω times the control period [1].
    omega=float,
    cosh=float,
    sinh=float,
    # Weight [N], load of an unloaded foot [N], length of a leg [m].
    weight=float,
    light_load=float,
    leg_length=float,
    # Soles: all of it, and the part that the ankles can press on the floor.
    sole=SOLE,
    support=SOLE,
    # Nominal centre of mass ahead of the base, and height of the base above the floor [m].
    com_ahead=float,
    height=float,
    # Chains of the legs, see `walking.body.kinematics`; hip in the base frame (3) [m], ankle in the
    # foot frame (3) [m] and maximum distance of both [m].
    chains=(float, 2, 7, 15),
    reach=(float, 2, 7),
    # Frames of left foot, right foot and camera: joint that carries it, -1 for the base, and its
    # pose on the link of this joint, see `RobotModel.on_link`.
    carriers=(int, 3),
    frames=(float, 3, 12),
    # First joint of the ankle in a leg; factor on the stiffness of the legs [1].
    ankle=int,
    stiffening=float,
    # Index and sign of the shoulder joints, -1 and 0 for none.
    shoulders=(int, 2),
    shoulder_signs=(float, 2),
    neck=NECK,
    # Strides of stepping in place.
    still=STRIDES,
    # Reaction of a swing leg: B, K and N of `walking.swing_reaction`.
    thrust=float,
    lifted_weight=float,
    knee=float,
    # Gains: of the CoM filter (position [1], velocity [1/s]), of the ankles per DCM error [1].
    position_gain=float,
    velocity_gain=float,
    ankle_gain=float,
)
"""Constants of the robot and of its walk."""

LEGS = slice(0, 12)  # joints


def parameters_for(robot: RobotModel, chosen: WalkingParameters | None = None) -> WalkingParameters:
    """Return the parameters of a robot; for HSR-VIII exactly the defaults.

    Args:
        robot: model of the robot.
        chosen: parameters to keep where they differ from the defaults; the others are scaled.
    """
    defaults = WalkingParameters()
    scaled = scale_parameters(defaults, HSR_VIII, robot.measures())
    return scaled if chosen is None else override(scaled, chosen, defaults)


def parameters_record(parameters: WalkingParameters) -> Record:
    """Return constants of which only the parameters are set (1,)."""
    robots = np.zeros(1, ROBOT)
    for name, section in SECTIONS.items():
        for key in section.names or ():
            value = getattr(getattr(parameters, name), key)
            robots[name][key] = GENERATORS.index(value) if isinstance(value, str) else value
    return robots


def robot_record(robot: RobotModel, parameters: WalkingParameters) -> Record:
    """Return the constants of a robot (1,).

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
    r.chains = [side.chain for side in robot.legs]
    r.reach = [side.reach for side in robot.legs]
    frames = (*robot.tree.feet, robot.tree.camera)
    r.carriers = [frame.joint for frame in frames]
    r.frames = [robot.on_link(frame) for frame in frames]
    r.ankle, r.stiffening = leg.ankle, robot.stiffening
    r.shoulders, r.shoulder_signs = robot.tree.shoulders or (-1, -1), robot.shoulder_signs()
    robot.neck.describe(r.neck)
    r.thrust, r.lifted_weight, r.knee = leg_reaction(robot, float(r.height), p.gait.swing_height)
    r.position_gain, r.velocity_gain = steady_gains(omega, p.estimator)
    ankles = slice(leg.ankle, 6)
    lag = float((robot.damping[ankles] / robot.stiffness[ankles]).max())
    r.ankle_gain = ankle_gain(omega, lag, p.stabilizer.dcm_rate)
    velocity_strides(r.still, STILL, p.gait.footstep_time, r)
    return records


def joint_records(robot: RobotModel, parameters: WalkingParameters) -> Record:
    """Return the joints of a robot (n,)."""
    p = parameters.stabilizer
    joints = np.zeros(robot.ready.size, JOINT)
    gain = np.ones(robot.ready.size)
    gain[LEGS] = p.velocity_gain
    joints["lower"], joints["upper"], joints["ready"] = robot.lower, robot.upper, robot.ready
    joints["lag"] = gain * robot.damping / robot.stiffness
    joints["compliance"] = 1.0 / robot.stiffness
    joints["in_q"], joints["in_v"] = robot.indices
    return joints
