"""Setpoint offsets that make up for the compliance of the position servos."""

import numpy as np
from numpy.typing import NDArray

from walking.body import leg_kernel
from walking.body.joints import LEFT_LEG, RIGHT_LEG
from walking.body.leg_kernel import AnkleTask, Point, Vector
from walking.body.robot_model import RobotModel
from walking.parameters import CONTROL_PERIOD, GRAVITY, StabilizerParameters

Array = NDArray[np.float64]


class FeedForward:
    """Load and velocity lag, both divided by the servos' stiffness, and the task of the ankles.

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
        self._servos = np.array(
            [parameters.load_gain / robot.stiffness, share * robot.damping / robot.stiffness]
        )
        pitch, roll = robot.stiffness[4:6].tolist()
        self._ankles = np.array([robot.mass * GRAVITY, pitch, roll, parameters.gyro_gain])
        law = parameters.inertia_gain, parameters.max_inertia_acceleration, CONTROL_PERIOD
        self._law = np.array(law)
        self._started = False
        self._position = np.zeros(robot.damping.size)
        self._velocity = np.zeros(robot.damping.size)

    def offsets(
        self,
        position: Array,
        pelvis: Vector,
        spots: tuple[Point, Point],
        right_load: float,
        acceleration: Point,
        *,
        task: AnkleTask,
    ) -> Array:
        """Offsets of all setpoints (26,) [rad].

        The floor gives all that the motion of the whole body takes, by inverse dynamics; the
        legs share it, and each foot has it under its own sole as far as the ZMP allows.

        Args:
            position: joint angles of this tick (26,) [rad].
            pelvis: x, y [m], heading [rad] in the plan frame.
            spots: where the ZMP is meant to be under either foot, in the plan frame [m].
            right_load: planned share of the weight on the right foot [1].
            acceleration: planned, of the base, in the plan frame [m/s²].
            task: what the ankles are to do besides.
        """
        if not self._started:
            self._started = True
            self._position[:] = position
        robot = self._robot
        leg_kernel.rates(
            position,
            self._position,
            self._velocity,
            *robot.motion,
            *robot.indices,
            pelvis,
            acceleration,
            self._law,
        )
        found = np.empty(position.size)
        leg_kernel.offsets(
            robot.forces(),
            robot.indices[1],
            position,
            self._velocity,
            self._servos,
            pelvis,
            spots,
            right_load,
            self._height,
            robot.leg_rows,
            task,
            self._ankles,
            found,
        )
        return found
