"""Rehearsal: walking without physics, to find what the joints of a robot can do.

Scaling by similarity ignores the speed, range and torque of the joints. The engine walks with its
own setpoints as sensor readings, and inverse dynamics gives the torques.
"""

from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from walking.body.robot_model import RobotModel
from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.plane import Array
from walking.state import BodySensors

AXES = ("vx", "vx_backward", "vy", "wz")
"""Speed limits, each of which bounds a command along one axis."""
STEPS = 8  # footsteps of a rehearsal
MAX_SPEED, MAX_TORQUE = 1.2, 1.0  # of the joints, of their maximum [1]
IN_PLACE_SPEED = 0.55  # of the joints in stepping in place, so that speed is left for the walk [1]
PERCENTILE = 99.0  # of speed and torque that counts: short peaks do not matter [%]
ROOM = 0.02  # of a loaded leg to the joint limits [rad]
IN_PLACE_ROOM = 0.05  # the same in stepping in place, so that room is left for a stride [rad]
AIR_ROOM = 0.12  # by which a leg in the air may exceed them [rad]
HELPS = 0.97  # of the joint speed after a lower swing that was worth it [1]
SHRINK, MIN_LIFT = 0.85, 0.03  # of the swing height; its minimum, of the length of the leg [1]
STRETCH, MAX_STRETCH = 1.1, 1.6  # of the footstep time
MIN_FRACTION = 0.05  # of a speed limit
BISECTIONS = 5


@dataclass(frozen=True, slots=True)
class Demand:
    """Demand of a walk on the joints.

    Attributes:
        speed: speed of the fastest joint over its maximum [1].
        torque: torque of the most loaded joint over its maximum [1].
        room: smallest distance to a joint limit [rad].
        joint: name of the joint that binds.
    """

    speed: float
    torque: float
    room: float
    joint: str

    @property
    def met(self) -> bool:
        """Whether the joints can do it."""
        return self._within(MAX_SPEED, ROOM)

    @property
    def leaves_room(self) -> bool:
        """Whether the joints can do it and have speed and room left for a walk."""
        return self._within(IN_PLACE_SPEED, IN_PLACE_ROOM)

    def _within(self, speed: float, room: float) -> bool:
        return self.speed <= speed and self.torque <= MAX_TORQUE and self.room >= room

    def text(self) -> str:
        """Return the demand in words."""
        if self.speed > IN_PLACE_SPEED and self.torque <= MAX_TORQUE and self.room >= ROOM:
            return f"{self.speed:.0%} of the speed of {self.joint}"
        if self.torque > MAX_TORQUE:
            return f"{self.torque:.0%} of the torque of {self.joint}"
        return f"{self.room:.2f} rad left at the limit of {self.joint}"


def rehearse(robot: RobotModel, parameters: WalkingParameters, command: VelocityCommand) -> Demand:
    """Return the demand of a walk.

    Args:
        robot: walking robot.
        parameters: parameters of the walk.
        command: constant command.
    """
    _, angles, loads, loaded = _walk(robot, parameters, command)
    speeds = np.abs(np.diff(angles, axis=0)) / CONTROL_PERIOD / robot.tree.speed[:12]
    torques = np.abs(loads) / robot.tree.effort[:12]
    speed, torque = (np.percentile(part, PERCENTILE, axis=0) for part in (speeds, torques))
    room = np.minimum(angles - robot.lower[:12], robot.upper[:12] - angles)
    # A foot in the air may tilt a little: its ankle stops at its limit.
    room = np.where(loaded, room, room + AIR_ROOM).min(axis=0)
    worst = [speed / MAX_SPEED, torque / MAX_TORQUE, ROOM / np.maximum(room, 1e-6)]
    joint = int(np.argmax(np.max(worst, axis=0)))
    return Demand(float(speed.max()), float(torque.max()), float(room.min()), robot.names[joint])


def postures(robot: RobotModel, parameters: WalkingParameters, command: VelocityCommand) -> Array:
    """Return the joint angles in a walk without physics (n, joints) [rad]."""
    return _walk(robot, parameters, command)[0]


def within_joints(
    robot: RobotModel, parameters: WalkingParameters, known: dict[str, float] | None = None
) -> tuple[WalkingParameters, list[str]]:
    """Return parameters with swing height, footstep time and speed limits the joints can do.

    Args:
        robot: walking robot.
        parameters: parameters of the walk.
        known: limits found by a calibration, instead of a search.

    Returns:
        The parameters, and notes on the changes.
    """
    notes: list[str] = []
    parameters = _with_lift(robot, parameters, notes)
    limits = parameters.limits
    if known is not None:
        return replace(parameters, limits=replace(limits, **known)), notes
    for name in AXES:
        top = getattr(limits, name)
        fraction, demand = _bisect(robot, parameters, name, top)
        if fraction < 1.0 and demand is not None:
            limits = replace(limits, **{name: fraction * top})
            notes.append(f"{name} {top:.2f} -> {fraction * top:.2f}: {demand.text()}")
    return replace(parameters, limits=limits), notes


def command_of(axis: str, speed: float) -> VelocityCommand:
    """Return the command along one axis of the speed limits.

    Args:
        axis: axis of `AXES`.
        speed: speed [m/s or rad/s].
    """
    sign = -1.0 if axis == "vx_backward" else 1.0
    return VelocityCommand(**{axis.removesuffix("_backward"): sign * speed})


def _with_lift(
    robot: RobotModel, parameters: WalkingParameters, notes: list[str]
) -> WalkingParameters:
    """Return parameters with which the robot can step in place."""
    slow = VelocityCommand(0.0, 0.0, MIN_FRACTION * parameters.limits.wz)
    lowest = MIN_LIFT * robot.legs[0].length
    fitted, demand = parameters, rehearse(robot, parameters, slow)
    reason = demand.text()
    while not demand.leaves_room and SHRINK * fitted.gait.swing_height > lowest:
        gait = replace(fitted.gait, swing_height=SHRINK * fitted.gait.swing_height)
        lower = replace(fitted, gait=gait)
        tried = rehearse(robot, lower, slow)
        if tried.speed > HELPS * demand.speed and tried.room <= demand.room:
            break  # a joint binds that the lift does not move
        fitted, demand = lower, tried
    while demand.speed > MAX_SPEED and fitted.gait.footstep_time < (
        MAX_STRETCH * parameters.gait.footstep_time
    ):
        gait = replace(fitted.gait, footstep_time=STRETCH * fitted.gait.footstep_time)
        fitted = replace(fitted, gait=gait)
        demand = rehearse(robot, fitted, slow)
    for name, unit in (("swing_height", "m"), ("footstep_time", "s")):
        before, after = getattr(parameters.gait, name), getattr(fitted.gait, name)
        if before != after:
            notes.append(f"{name} {before:.3f} -> {after:.3f} {unit}: {reason}")
    return fitted


def _bisect(
    robot: RobotModel, parameters: WalkingParameters, axis: str, top: float
) -> tuple[float, Demand | None]:
    """Return the largest fraction of a speed that the joints can do, and the demand beyond it."""
    demand = rehearse(robot, parameters, command_of(axis, top))
    if demand.met:
        return 1.0, None
    low, high, beyond = MIN_FRACTION, 1.0, demand
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        demand = rehearse(robot, parameters, command_of(axis, middle * top))
        if demand.met:
            low = middle
        else:
            high, beyond = middle, demand
    return low, beyond


def _walk(
    robot: RobotModel, parameters: WalkingParameters, command: VelocityCommand
) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
    """Walk without physics.

    Returns:
        Setpoints of all joints (n, joints) [rad]; angles [rad] and torques [N m] of the legs, and
        which is loaded (n, 12).
    """
    engine = WalkingEngine(robot, parameters)
    q, weight = robot.ready.copy(), robot.mass * GRAVITY
    rates = np.zeros_like(q)
    settle = round(parameters.gait.settle_time / CONTROL_PERIOD) + 1
    ticks = settle + round((1.0 + STEPS) * parameters.gait.footstep_time / CONTROL_PERIOD)
    positions, angles, torques, loaded = [], [], [], []
    for _ in range(ticks):
        yaw, load = engine.heading, engine.load
        sensors = BodySensors(
            joint_position=q,
            joint_velocity=rates,
            gyro=np.zeros(3),
            accelerometer=np.array([0.0, 0.0, GRAVITY]),
            orientation=np.array([cos(0.5 * yaw), 0.0, 0.0, sin(0.5 * yaw)]),
            foot_force=weight * np.outer((1.0 - load, load), np.full(4, 0.25)),
        )
        targets = engine.step(sensors, command, HeadTarget())
        rates = (targets.position - q) / CONTROL_PERIOD
        q = targets.position.copy()
        positions.append(q)
        angles.append(engine.leg_angles)
        torques.append(engine.torques[:12])
        loaded.append(np.repeat((load < 1.0, load > 0.0), 6))
    walked = slice(settle, None)
    whole = np.array(positions)[walked], np.array(angles)[walked], np.array(torques)[walked]
    return *whole, np.array(loaded)[walked]
