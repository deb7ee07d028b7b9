"""Walker: the walking engine, and getting up after a fall."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Protocol

import numpy as np

from walking.body.robot_model import RobotModel
from walking.command import Command, CommandLimits, CommandState, HeadTarget, Limit, VelocityCommand
from walking.engine import PlanDiverged, WalkingEngine
from walking.estimate.odometry import LegOdometry
from walking.get_up import GetUp, Outcome
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.state import BodySensors, JointTargets, Phase, WalkingState

START_TIME = 0.03  # double support before the first footstep of the warm-up [s]
TICKS = 20  # of the warm-up, enough for a double and a single support


def warm_up(robot: RobotModel, parameters: WalkingParameters) -> None:
    """Compile or load every function that a control tick calls; the robot does not move."""
    at_once = replace(parameters.gait, settle_time=0.0, start_time=START_TIME)
    engine = WalkingEngine(robot, replace(parameters, gait=at_once))
    sensors = BodySensors(
        joint_position=robot.ready,
        joint_velocity=np.zeros_like(robot.ready),
        gyro=np.zeros(3),
        accelerometer=np.array([0.0, 0.0, GRAVITY]),
        orientation=np.array([1.0, 0.0, 0.0, 0.0]),
        foot_force=np.full((2, 4), robot.mass * GRAVITY / 8.0),
    )
    forward = VelocityCommand(parameters.limits.forward_acceleration * CONTROL_PERIOD)
    for _ in range(TICKS):
        engine.step(sensors, forward, HeadTarget())
    engine.step(sensors, CommandState(), HeadTarget())
    engine.state()


class Engine(Protocol):
    """Walking from standing until the first fall; `WalkingEngine` or a replacement."""

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that limited the last command."""

    @property
    def zmp_depth(self) -> float:
        """Distance of the last planned ZMP from the edge of the support polygon [m]."""

    @property
    def fallen(self) -> bool:
        """Whether the tilt of the trunk is that of a fallen robot."""

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """Run one control tick and return the setpoints of all joints."""

    def observe(self, sensors: BodySensors) -> None:
        """Update only the attitude in a tick in which something else moves the joints."""

    def state(self) -> WalkingState:
        """Return the state after the last tick."""


class Walker:
    """Walking engine with fall recovery: call `step` once per control tick of 5 ms.

    After a fall a new engine starts from standing, and also if the plan diverges, say between two
    people who squeeze the robot. It keeps the odometry, whose covariance grows by the unmeasured
    motion.

    Args:
        robot: model of the robot.
        parameters: parameters of walking and getting up.
        engine: factory of the engine that continues an odometry; by default a `WalkingEngine`.

    Attributes:
        get_up: recovery from the present fall, None while walking.
    """

    def __init__(
        self,
        robot: RobotModel,
        parameters: WalkingParameters,
        engine: Callable[[LegOdometry], Engine] | None = None,
    ) -> None:
        self._robot = robot
        self._parameters = parameters
        if engine is None:
            warm_up(robot, parameters)
            engine = partial(WalkingEngine, robot, parameters)
        self._make_engine = engine
        self._odometry = LegOdometry(parameters.odometry)
        self._engine = engine(self._odometry)
        self.get_up: GetUp | None = None
        self._command: Command = VelocityCommand()
        self._steps = 0

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that limited the last command."""
        return self._engine.limits if self.get_up is None else (Limit.FALLEN,)

    @property
    def zmp_depth(self) -> float:
        """Distance of the last planned ZMP from the edge of the support polygon [m]."""
        return self._engine.zmp_depth

    @property
    def yaw(self) -> float:
        """Heading in the odometry frame [rad]."""
        return self._odometry.yaw

    @property
    def down(self) -> bool:
        """Whether the robot lies or gets up, and ignores commands."""
        return self.get_up is not None

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """Run one control tick.

        Args:
            sensors: read at the start of the tick.
            command: velocity or footsteps; ignored while the robot is down.
            head: gaze direction; ignored while the robot is down.

        Returns:
            setpoints of all joints.
        """
        get_up, self._command = self.get_up, command
        if get_up is None:
            try:
                targets = self._engine.step(sensors, command, head)
            except PlanDiverged:
                self._stand()
                targets = self._engine.step(sensors, command, head)
            if self._parameters.get_up.enabled and self._engine.fallen:
                angles = targets.setpoint
                self.get_up = GetUp(self._robot, self._parameters.get_up, angles)
            return targets
        self._engine.observe(sensors)
        targets = get_up.step(sensors)
        if get_up.outcome is not Outcome.UP:
            return targets
        self._stand()
        return self._engine.step(sensors, command, head)

    def state(self) -> WalkingState:
        """Return the state after the last tick.

        Raises:
            RuntimeError: before the first tick.
        """
        state = self._engine.state()
        steps = self._steps + state.step_count
        if self.get_up is None:
            return replace(state, step_count=steps) if self._steps else state
        gave_up = self.get_up.outcome is Outcome.GAVE_UP
        phase = Phase.FALLEN if gave_up else Phase.GETTING_UP
        return replace(
            state,
            step_count=steps,
            phase=phase,
            fallen=True,
            applied_velocity=np.zeros(3),
            command_limits=CommandLimits(self._command, VelocityCommand(), self.limits),
        )

    def _stand(self) -> None:
        """Start to walk again from the ready posture."""
        p = self._parameters
        self._steps = self.state().step_count
        self._odometry.interrupt(p.get_up.displacement_sigma, p.get_up.yaw_sigma)
        self._engine = self._make_engine(self._odometry)
        self.get_up = None
