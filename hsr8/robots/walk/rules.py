"""Rules that fit the scaled parameters to a robot's soles, joints and servos.

Scaling by similarity assumes a robot built like HSR-VIII. Each rule bounds a parameter where
another build would fall, see `docs/robots.md`.
"""

from dataclasses import replace
from math import sqrt

import numpy as np

from walking.body.feedforward import support_torque
from walking.body.kinematics import FootPose
from walking.body.robot_model import RobotModel
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.dimension import HSR_VIII
from walking.parameters import (
    CONTROL_PERIOD,
    GRAVITY,
    GaitParameters,
    LimitParameters,
    StabilizerParameters,
    WalkingParameters,
)
from walking.plane import Array

MAX_GYRO_GAIN = 0.12  # ankle setpoint per angular velocity; above, soft ankles oscillate [s]
SOLE_FRACTION = 1.0 / 3.0  # maximum margin of the ZMP moved by the ankles, of that half width [1]
REFERENCE_WIDTH = HSR_VIII.sole / HSR_VIII.leg  # of a sole, of the length of the leg [1]
MAX_SLOWER = 1.4  # footstep time, of that by similarity [1]
MIN_LAGS = 9.0  # duration of a footstep, of the lag of the slowest leg servo [1]
MAX_STANCE = 0.2  # half stance, of the length of the leg [1]
MAX_LOAD = 0.7  # torque of a pitching joint on one leg, of its maximum [1]
JOINT_ROOM = 0.05  # of a walking leg to its joint limits [rad]
REACHED = 1e-6  # error of a leg that reaches its foot [rad]
STRIDE = 0.12  # of a walking leg forward and backward, of its length [1]
RAISE, MAX_HEIGHT = 0.01, 0.93  # step and end of the search for a hip height, of the leg [1]
NARROWER = 0.02  # step of the search for a reach, of that by similarity [1]


def fit(robot: RobotModel, scaled: WalkingParameters) -> WalkingParameters:
    """Return the scaled parameters of a robot within all rules."""
    gait = with_clear_stance(robot, scaled.gait)
    pattern = scaled.pattern
    height = hip_height(robot, gait, pattern.pelvis_height)
    limits = with_side_reach(robot, scaled.limits, gait.half_stance, height)
    return replace(
        scaled,
        gait=with_calm_landing(robot, with_servo_time(robot, gait)),
        pattern=replace(pattern, pelvis_height=height),
        stabilizer=with_gains(robot, scaled.stabilizer),
        limits=limits,
    )


def with_gains(robot: RobotModel, stabilizer: StabilizerParameters) -> StabilizerParameters:
    """Return full feed-forward of the lag, bounded damping, and ankles that use the sole.

    A part of the lag lets slow servos fall behind, and so do rates of half a tick ago in a setpoint
    that holds for the next tick; damping scaled to soft ankles oscillates with
    the delay of the servos; a margin scaled to the legs leaves nothing of a narrow sole.
    """
    margin = SOLE_FRACTION * robot.support.half_width
    return replace(
        stabilizer,
        velocity_gain=1.0,
        velocity_ahead=CONTROL_PERIOD,
        gyro_gain=min(stabilizer.gyro_gain, MAX_GYRO_GAIN),
        sole_margin=min(stabilizer.sole_margin, margin),
    )


def with_clear_stance(robot: RobotModel, gait: GaitParameters) -> GaitParameters:
    """Return a stance in which the soles do not overlap, no wider than the legs can shift."""
    clear = robot.sole.half_width + gait.foot_clearance
    most = max(clear, MAX_STANCE * robot.legs[0].length)
    return replace(gait, half_stance=min(most, max(gait.half_stance, clear)))


def with_servo_time(robot: RobotModel, gait: GaitParameters) -> GaitParameters:
    """Return footsteps that are long against the lag of the leg servos.

    A swing that ends before slow servos have followed lands short, and the walk is inexact.
    """
    pitching = _pitching(robot)
    lag = float((robot.damping[pitching] / robot.stiffness[pitching]).max())
    most = MAX_SLOWER * gait.footstep_time
    return replace(gait, footstep_time=max(gait.footstep_time, min(MIN_LAGS * lag, most)))


def with_calm_landing(robot: RobotModel, gait: GaitParameters) -> GaitParameters:
    """Return landings that change earlier and slower where soles are narrow.

    A foot that is sent elsewhere pushes the robot back by a part of its weight, at the height of
    the hips; soles that are narrow against the leg tip over. The push falls with the square of the
    time left.
    """
    width = robot.support.half_width / robot.legs[0].length
    part = min(1.0, width / REFERENCE_WIDTH)
    return replace(
        gait,
        landing_freeze=1.0 - (1.0 - gait.landing_freeze) / sqrt(part),
        landing_speed=part * gait.landing_speed,
        landing_turn=part * gait.landing_turn,
    )


def hip_height(robot: RobotModel, gait: GaitParameters, height: float) -> float:
    """Return a height of the hips at which the bent legs can walk [m].

    The hips are raised until a stride leaves room to every joint limit, and the weight on one leg
    leaves torque in its pitching joints; where no height does, to that which comes nearest.

    Args:
        robot: walking robot.
        gait: footsteps, with the stance.
        height: wanted height of the hips [m].
    """
    length, pitching = robot.legs[0].length, _pitching(robot)
    heights = np.arange(height, MAX_HEIGHT * length, RAISE * length).tolist() or [height]
    lacking = []
    for each in heights:
        load = float(one_leg_load(robot, gait.half_stance, each)[pitching].max())
        room = stride_room(robot, gait.half_stance, each)
        lacking.append(max(0.0, JOINT_ROOM - room) + max(0.0, load - MAX_LOAD))
        if lacking[-1] == 0.0:
            return float(each)
    return float(heights[int(np.argmin(lacking))])


def one_leg_load(robot: RobotModel, half_stance: float, height: float) -> Array:
    """Return the torque of every leg joint that carries the weight alone, of its maximum (12,) [1].

    The force of the floor on the middle of the sole points to the centre of mass.

    Args:
        robot: standing robot.
        half_stance: distance of a foot from the middle of the stance [m].
        height: height of the hips [m].
    """
    loads = np.zeros(12)
    com = robot.com(robot.ready)
    for leg, part, side in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), (1.0, -1.0), strict=True):
        foot = FootPose(leg.foot[0], side * half_stance, leg.hip[2] - height)
        axes, origins = leg.joints(leg.angles(foot)[0])
        point = np.array([foot.x + robot.sole.centre, foot.y, foot.z])
        up = np.array([0.0, com[1] - foot.y, com[2] - foot.z])
        force = robot.mass * GRAVITY * up / up[2]
        torques = [
            support_torque(axis, origin, tuple(point), tuple(force))
            for axis, origin in zip(axes, origins, strict=True)
        ]
        loads[part] = np.abs(torques) / robot.tree.effort[part]
    return loads


def stride_room(robot: RobotModel, half_stance: float, height: float) -> float:
    """Return the smallest distance of the leg joints to their limits in a stride [rad].

    Where a foot is out of reach, it is negative.
    """
    strides = (0.0, STRIDE * robot.legs[0].length, -STRIDE * robot.legs[0].length)
    return min(_room(robot, half_stance, ahead, height) for ahead in strides)


def with_side_reach(
    robot: RobotModel, limits: LimitParameters, half_stance: float, height: float
) -> LimitParameters:
    """Return a lateral reach at which both soles are flat with the pelvis between them.

    A capture step beyond the range of the ankle roll lands on the edge of the sole, and so does the
    next one to the other side.
    """
    most = limits.reach_side
    for part in np.arange(1.0, NARROWER, -NARROWER).tolist():
        if _room(robot, half_stance + 0.5 * part * most, 0.0, height) >= JOINT_ROOM:
            return replace(limits, reach_side=part * most)
    return limits


def _room(robot: RobotModel, half_stance: float, ahead: float, height: float) -> float:
    """Return the smallest distance of the leg joints to their limits [rad], -1 if out of reach."""
    room = np.inf
    for leg, part, side in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), (1.0, -1.0), strict=True):
        foot = FootPose(leg.foot[0] + ahead, side * half_stance, leg.hip[2] - height)
        angles, error = leg.angles(foot)
        if error > REACHED:
            return -1.0
        room = min(room, (angles - robot.lower[part]).min(), (robot.upper[part] - angles).min())
    return float(room)


def _pitching(robot: RobotModel) -> list[int]:
    """Return the pitching joints of both legs, which a crouch loads."""
    return [6 * side + k for side in range(2) for k in robot.legs[side].pitching]
