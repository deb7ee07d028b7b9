"""Head motion within limits of rate and acceleration, and the joints that move the optical axis."""

from math import asin, atan2, cos, sin, sqrt

import numpy as np

from compilation import compiled
from walking.body.robot_model import RobotModel
from walking.command import HeadTarget
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.plane import Array, Point
from walking.records import JOINT, LIMBS, Record, parameters_record


class Head:
    """Head of a robot whose legs something else moves.

    Args:
        robot: model of the robot.
        parameters: parameters of its motion.
    """

    def __init__(self, robot: RobotModel, parameters: WalkingParameters) -> None:
        self._limbs, self._robot = np.zeros(1, LIMBS)[0], parameters_record(parameters)[0]
        self._joints = np.zeros(robot.ready.size, JOINT)
        self._joints["lower"], self._joints["upper"] = robot.lower, robot.upper
        robot.neck.describe(self._robot.neck)
        self._limbs.head = robot.neck.angles(robot.ready)

    def advance(self, target: HeadTarget) -> Array:
        """Run one tick; return the setpoints of pan and tilt joint [rad], none if it is fixed."""
        advance_head(self._limbs, (target.pan, target.tilt), self._robot)
        return self.joints(*self._limbs.head.tolist())

    @property
    def angles(self) -> Array:
        """Pan and tilt (2,) [rad]."""
        return np.array(self._limbs.head)

    @property
    def rates(self) -> Array:
        """Rates of pan and tilt (2,) [rad/s]."""
        return np.array(self._limbs.head_rate)

    def joints(self, pan: float, tilt: float) -> Array:
        """Return the angles of pan and tilt joint for pan and tilt [rad], none if it is fixed."""
        if not self._robot.neck.movable:
            return np.zeros(0)
        return np.array(head_joints(pan, tilt, self._joints, self._robot))


@compiled
def advance_head(limbs: Record, target: Point, robot: Record) -> None:
    """Run one tick: time-optimal approach to the target on each axis, without overshoot.

    Args:
        limbs: pan and tilt and their rates, changed.
        target: pan and tilt [rad].
        robot: constants.
    """
    p, neck = robot.head, robot.neck
    step = p.max_acceleration * CONTROL_PERIOD
    for axis in range(2):
        goal = min(neck.upper[axis], max(neck.lower[axis], target[axis]))
        error = goal - limbs.head[axis]
        # Maximum speed from which whole ticks of braking end at the target.
        reach = step * (sqrt(0.25 + 2.0 * abs(error) / (step * CONTROL_PERIOD)) - 0.5)
        wanted = min(p.max_rate, reach, abs(error) / CONTROL_PERIOD)
        wanted = wanted if error >= 0.0 else -wanted
        limbs.head_rate[axis] += min(step, max(-step, wanted - limbs.head_rate[axis]))
        limbs.head[axis] += limbs.head_rate[axis] * CONTROL_PERIOD


@compiled
def head_joints(pan: float, tilt: float, joints: Record, robot: Record) -> Point:
    """Return the angles of pan and tilt joint, within their range, for pan and tilt [rad]."""
    neck = robot.neck
    if not neck.movable:
        return 0.0, 0.0
    if neck.tilt_first:
        # The pan joint turns about a tilted axis: it alone moves the optical axis sideways.
        flat = cos(neck.rest_tilt)
        side = asin(min(1.0, max(-1.0, cos(tilt) * sin(pan) / flat)))
        raised = atan2(sin(tilt), cos(tilt) * cos(pan))
        bent = atan2(sin(neck.rest_tilt), flat * cos(side))
        pan, tilt = side, raised - bent + neck.rest_tilt
    first, second = joints[neck.pan_joint], joints[neck.tilt_joint]
    return (
        min(first.upper, max(first.lower, neck.pan_sign * (pan - neck.rest_pan))),
        min(second.upper, max(second.lower, neck.tilt_sign * (tilt - neck.rest_tilt))),
    )
