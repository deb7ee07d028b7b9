"""Feed-forward offsets of the setpoints against the compliance of the position servos."""

import numpy as np

from walking.arrays import Array, Point, Vector
from walking.body import feedforward_kernel
from walking.body.feedforward_kernel import AnkleTask
from walking.body.robot_model import RobotModel
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.parameters import CONTROL_PERIOD, GRAVITY, StabilizerParameters


class FeedForward:
    """Feed-forward of load torques and velocity lag, and the ankle strategy.

    Args:
        robot: masses and servo gains.
        parameters: feed-forward gains.
        height: of the base above the floor [m].
    """

    def __init__(self, robot: RobotModel, parameters: StabilizerParameters, height: float) -> None:
        self._robot = robot
        self._height = height
        gain = np.full(robot.damping.size, parameters.upper_velocity_gain)
        gain[LEFT_LEG] = gain[RIGHT_LEG] = parameters.velocity_gain
        self._servos = np.array(
            [
                parameters.load_gain / robot.stiffness,
                gain * robot.damping / robot.stiffness,
                1.0 / robot.stiffness,
            ]
        )
        ankles = robot.mass * GRAVITY, parameters.gyro_gain, float(robot.legs[0].ankle)
        self._ankles = np.array(ankles)
        inertia = parameters.inertia_gain, parameters.max_inertia_acceleration, CONTROL_PERIOD
        self._inertia = np.array(inertia)
        self._time_ahead = parameters.velocity_ahead
        self._started = False
        self._position = np.zeros(robot.damping.size)
        self._velocity = np.zeros(robot.damping.size)
        self._ahead = np.zeros(robot.damping.size)
        self._offset = np.zeros(robot.damping.size)

    def offsets(
        self,
        position: Array,
        pelvis: Vector,
        foot_zmps: tuple[Point, Point],
        right_load: float,
        acceleration: Point,
        *,
        legs: tuple[Array, Array],
        task: AnkleTask,
    ) -> Array:
        """Return the offsets of all setpoints (n,) [rad].

        Inverse dynamics gives the contact wrench of the whole-body motion; the legs share it by
        load, with the force under each sole at the planned ZMP.

        Args:
            position: joint angles of this tick (n,) [rad].
            pelvis: x, y [m], heading [rad] in the plan frame.
            foot_zmps: planned ZMP under each foot, in the plan frame [m].
            right_load: planned load fraction of the right foot [1].
            acceleration: planned, of the base, in the plan frame [m/s²].
            legs: axes (2, 6, 3) and origins (2, 6, 3) [m] of their joints in the base frame.
            task: of the ankles.
        """
        if not self._started:
            self._started = True
            self._position[:] = position
        robot = self._robot
        feedforward_kernel.rates(
            position,
            self._position,
            self._velocity,
            *robot.motion,
            *robot.indices,
            pelvis,
            acceleration,
            self._inertia,
        )
        self._ahead = self._velocity + self._time_ahead * robot.motion[2][robot.indices[1]]
        offset = self._offset
        feedforward_kernel.offsets(
            robot.forces(),
            robot.indices[1],
            self._ahead,
            self._servos,
            pelvis,
            foot_zmps,
            right_load,
            self._height,
            *legs,
            task,
            self._ankles,
            offset,
        )
        return offset.copy()

    def torques(self) -> Array:
        """Return the planned torques of all joints in the last tick (n,) [N m]."""
        lag, compliance = self._servos[1:]
        torques: Array = (self._offset - self._ahead * lag) / compliance
        return torques
