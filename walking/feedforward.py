"""Set-point offsets that make up for the compliance of the position servos."""

import numpy as np
from numpy.typing import NDArray

from walking.joints import LEFT_LEG, RIGHT_LEG
from walking.leg_kinematics import LegAngles, support_torques
from walking.parameters import CONTROL_PERIOD, StabilizerParameters
from walking.robot_model import RobotModel

Array = NDArray[np.float64]
Point = tuple[float, float]


class FeedForward:
    """Load and velocity lag, both divided by the servos' stiffness.

    Args:
        robot: masses and servo gains.
        parameters: shares fed forward.
        height: of the base above the floor [m].
    """

    def __init__(self, robot: RobotModel, parameters: StabilizerParameters, height: float) -> None:
        self._robot = robot
        self._height = height
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
        soles: tuple[Point, Point],
        right_load: float,
        acceleration: Point,
    ) -> Array:
        """Offsets of all set-points (26,) [rad].

        The floor gives all that the motion of the whole body takes, by inverse dynamics; the
        legs share it, and each foot has it under its own sole as far as the ZMP allows.

        Args:
            position: joint angles of this tick (26,) [rad].
            legs: those of the legs.
            soles: where the ZMP is meant to be under either foot, in the base frame [m].
            right_load: planned share of the weight on the right foot [1].
            acceleration: planned, of the base, forward and left [m/s²].
        """
        before = self._position if self._position is not None else position
        velocity = (position - before) / CONTROL_PERIOD
        change = self._inertia * (velocity - self._velocity) / CONTROL_PERIOD
        self._position, self._velocity = position, velocity
        torque, wrench = self._robot.inverse_dynamics(
            position, velocity, change.clip(-self._limit, self._limit), acceleration
        )
        fx, fy, fz, nx, ny, _ = wrench.tolist()
        h = self._height
        (lx, ly), (rx, ry) = soles
        left_load = 1.0 - right_load
        # The ZMP of the whole body, from where the feet alone would have it.
        dx = -(ny + h * fx) / fz - left_load * lx - right_load * rx
        dy = (nx - h * fy) / fz - left_load * ly - right_load * ry
        for leg, angles, part, load, (x, y) in zip(
            self._robot.legs,
            legs,
            (LEFT_LEG, RIGHT_LEG),
            (left_load, right_load),
            soles,
            strict=True,
        ):
            if load > 0.0:
                point, force = (x + dx, y + dy, -h), (load * fx, load * fy, load * fz)
                torque[part] += support_torques(leg, angles, point, force)
        return torque * self._compliance + velocity * self._lag
