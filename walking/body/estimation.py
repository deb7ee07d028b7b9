"""State estimation: attitude, feet, odometry, and the error against the plan."""

import numpy as np

from walking.arrays import Array, Point
from walking.body import estimation_kernel, kinematics_kernel
from walking.body.estimation_kernel import LOAD, MEASURED, Plan
from walking.body.measurement import BodyMeasurement, body_of
from walking.body.odometry import LegOdometry
from walking.body.robot_model import RobotModel
from walking.body.steady_gains import steady_gains
from walking.parameters import CONTROL_PERIOD, GRAVITY, EstimatorParameters
from walking.sensing import BodySensors

LIGHT_LOAD = 0.074  # of the weight; the noise of unloaded foot pads stays below it [1]


class Estimation:
    """Filters the sensors and compares the body with the plan.

    Args:
        robot: dimensions and masses.
        omega: of the pendulum [1/s].
        parameters: noise levels.
        odometry: dead reckoning, updated in place.

    Attributes:
        measured: measurements of the last tick, see `estimation_kernel.observe` (24,).
        tilt: filtered roll and pitch of the trunk; None before the first tick [rad].
        dcm_error: measured minus planned DCM [m].
        pressure_error: centre of pressure minus planned ZMP, forward and left; zero in the air [m].
        pose: by odometry (x, y, heading) [m, m, rad].
    """

    def __init__(
        self,
        robot: RobotModel,
        omega: float,
        parameters: EstimatorParameters,
        odometry: LegOdometry,
    ) -> None:
        self._robot = robot
        self._odometry = odometry
        self._filter, self._error = np.zeros(3), np.zeros(5)
        self._error[4] = -1.0
        sole = robot.sole
        light = LIGHT_LOAD * robot.mass * GRAVITY
        body = parameters.tilt_gain, light, sole.centre, sole.half_length, sole.half_width
        self._body = np.array(body)
        self._gains = np.array([*steady_gains(omega, parameters), omega])
        self.measured = np.zeros(MEASURED)
        self._feet = np.zeros((2, 4))
        self.tilt: Point | None = None
        self.dcm_error: Point = (0.0, 0.0)
        self.pressure_error: Point = (0.0, 0.0)
        self.pose = (0.0, 0.0, 0.0)

    @property
    def body(self) -> BodyMeasurement | None:
        """Measurement of the last tick, None before the first."""
        return None if self.tilt is None else body_of(self.measured.tolist())

    @property
    def com_error(self) -> tuple[float, float, float, float]:
        """Measured minus planned centre of mass: x, y [m], vx, vy [m/s]."""
        x, y, vx, vy, _ = self._error.tolist()
        return x, y, vx, vy

    def load(self, foot: int) -> float:
        """Return the load on the left (0) or the right foot (1) [N]."""
        return float(self.measured[LOAD + 5 * foot])

    def observe(self, sensors: BodySensors) -> None:
        """Measure the body and filter its tilt in a tick without a plan."""
        self.tilt = estimation_kernel.observe(
            *self._inputs(sensors), self._body, CONTROL_PERIOD, self.measured
        )

    def update(self, sensors: BodySensors, feet: Array, plan: Plan, *, stepping: bool) -> Point:
        """Update the estimate in a tick of a walk.

        Args:
            sensors: read at its start.
            feet: foot references, see `walking.gait.swing_foot_kernel` (2, 10).
            plan: of the last tick, see `estimation_kernel.Plan`.
            stepping: whether a footstep is under way.

        Returns:
            roll and pitch of the trunk [rad].
        """
        odometry = self._odometry
        tilt, self.dcm_error, self.pressure_error, self.pose = estimation_kernel.estimate(
            *self._inputs(sensors),
            odometry.state,
            self._error,
            self._body,
            odometry.growth,
            self._gains,
            feet,
            plan,
            stepping,
            CONTROL_PERIOD,
            self.measured,
        )
        self.tilt = tilt
        return tilt

    def _inputs(self, sensors: BodySensors) -> tuple[Array, Array, Array, Array, Array, Array]:
        """Return the first arguments of `observe` and `estimate`."""
        joints, com = sensors.joint_position, self._robot.com(sensors.joint_position)
        kinematics_kernel.feet_poses(*self._robot.feet_chains, joints, self._feet)
        pads = sensors.foot_force
        return self._feet, pads, sensors.orientation, sensors.gyro, com, self._filter
