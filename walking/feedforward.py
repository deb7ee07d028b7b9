"""Set-point offsets that make up for the compliance of the position servos."""

import numpy as np
from numpy.typing import NDArray

from walking.joints import LEFT_LEG, RIGHT_LEG
from walking.leg_kinematics import LegAngles, support_torques
from walking.parameters import CONTROL_PERIOD, GRAVITY, StabilizerParameters
from walking.robot_model import RobotModel

Array = NDArray[np.float64]


class FeedForward:
    """Load and velocity lag, both divided by the servos' stiffness.

    Args:
        robot: masses and servo gains.
        parameters: shares fed forward.
        height: of the base above the floor [m].
    """

    def __init__(self, robot: RobotModel, parameters: StabilizerParameters, height: float) -> None:
        self._robot = robot
        self._weight = robot.mass * GRAVITY
        self._height = height
        self._horizontal = parameters.horizontal_gain
        share = np.full(robot.damping.size, parameters.upper_velocity_gain)
        share[LEFT_LEG] = share[RIGHT_LEG] = parameters.velocity_gain
        self._lag = share * robot.damping / robot.stiffness
        self._compliance = parameters.load_gain / robot.stiffness
        self._inertia = parameters.inertia_gain
        self._limit = parameters.inertia_limit
        self._position: Array | None = None
        self._velocity = np.zeros(robot.damping.size)

    def offsets(
        self,
        position: Array,
        legs: tuple[LegAngles, LegAngles],
        zmp: tuple[float, float],
        right_load: float,
        acceleration: tuple[float, float],
    ) -> Array:
        """Offsets of all set-points (26,) [rad].

        Args:
            position: joint angles of this tick (26,) [rad].
            legs: those of the legs.
            zmp: planned ZMP in the base frame [m].
            right_load: planned share of the weight on the right foot [1].
            acceleration: planned, of the base, forward and left [m/s²].
        """
        before = self._position if self._position is not None else position
        velocity = (position - before) / CONTROL_PERIOD
        change = self._inertia * (velocity - self._velocity) / CONTROL_PERIOD
        self._position, self._velocity = position, velocity
        torque = self._robot.joint_torque(
            position, velocity, change.clip(-self._limit, self._limit), acceleration
        )
        point = (zmp[0], zmp[1], -self._height)
        share = self._horizontal / GRAVITY
        push = (share * acceleration[0], share * acceleration[1], 1.0)
        for leg, angles, part, load in zip(
            self._robot.legs,
            legs,
            (LEFT_LEG, RIGHT_LEG),
            (1.0 - right_load, right_load),
            strict=True,
        ):
            if load > 0.0:
                weight = self._weight * load
                force = (weight * push[0], weight * push[1], weight)
                torque[part] += support_torques(leg, angles, point, force)
        return torque * self._compliance + velocity * self._lag
