"""Set-point offsets that make up for the compliance of the position servos."""

import numpy as np
from numpy.typing import NDArray

from walking.joints import LEFT_LEG, RIGHT_LEG
from walking.leg_kinematics import LegAngles, support_torques
from walking.parameters import CONTROL_PERIOD, GRAVITY, StabilizerParameters
from walking.robot_model import RobotModel

Array = NDArray[np.float64]


class FeedForward:
    """Static load and velocity lag, both divided by the servos' stiffness.

    Args:
        robot: masses and servo gains.
        parameters: shares fed forward.
    """

    def __init__(self, robot: RobotModel, parameters: StabilizerParameters) -> None:
        self._robot = robot
        self._weight = robot.mass * GRAVITY
        share = np.full(robot.damping.size, parameters.upper_velocity_gain)
        share[LEFT_LEG] = share[RIGHT_LEG] = parameters.velocity_gain
        self._lag = share * robot.damping / robot.stiffness / CONTROL_PERIOD
        self._gravity = parameters.gravity_gain / robot.stiffness
        self._before: Array | None = None

    def offsets(
        self,
        position: Array,
        legs: tuple[LegAngles, LegAngles],
        zmp: tuple[float, float],
        right_load: float,
    ) -> Array:
        """Offsets of all set-points (26,) [rad].

        Args:
            position: joint angles of this tick (26,) [rad].
            legs: those of the legs.
            zmp: planned ZMP in the base frame [m].
            right_load: planned share of the weight on the right foot [1].
        """
        torque = np.array(self._robot.gravity_torque(position))
        point = (zmp[0], zmp[1], 0.0)
        for leg, angles, part, load in zip(
            self._robot.legs,
            legs,
            (LEFT_LEG, RIGHT_LEG),
            (1.0 - right_load, right_load),
            strict=True,
        ):
            if load > 0.0:
                torque[part] += support_torques(leg, angles, point, self._weight * load)
        before = self._before if self._before is not None else position
        self._before = position
        return torque * self._gravity + (position - before) * self._lag
