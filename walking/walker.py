"""Walking that survives a fall: the engine, and getting up when it has failed."""

from dataclasses import replace

import numpy as np

from walking.body.odometry import LegOdometry
from walking.body.robot_model import RobotModel
from walking.command import Command, HeadTarget, VelocityCommand
from walking.command_limits import CommandLimits, Limit
from walking.engine import WalkingEngine
from walking.get_up.get_up import GetUp, Outcome
from walking.parameters import WalkingParameters
from walking.phase import Phase
from walking.sensing import BodySensors
from walking.state import WalkingState
from walking.targets import JointTargets
from walking.warm_up import warm_up


class Walker:
    """Walks a humanoid and gets it up again: call `step` once per control tick of 5 ms.

    After a fall a new engine begins from standing; it goes on with the odometry of the one
    before, whose covariance grows by what the fall has hidden.

    Args:
        robot: the robot's numbers.
        parameters: of walking and getting up.

    Attributes:
        get_up: the fall that is under way, if one is.
    """

    def __init__(self, robot: RobotModel, parameters: WalkingParameters) -> None:
        self._robot = robot
        self._parameters = parameters
        warm_up(robot, parameters)
        self._odometry = LegOdometry(parameters.odometry)
        self._engine = WalkingEngine(robot, parameters, self._odometry)
        self.get_up: GetUp | None = None
        self._command: Command = VelocityCommand()
        self._steps = 0

    @property
    def parameters(self) -> WalkingParameters:
        """Parameters of walking and getting up."""
        return self._parameters

    @property
    def command_limits(self) -> CommandLimits:
        """What became of the last tick's command: nothing while the robot is down."""
        if self.get_up is None:
            return self._engine.command_limits
        return CommandLimits(self._command, VelocityCommand(), self.limits)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that altered that command, none if it is obeyed."""
        return self._engine.limits if self.get_up is None else (Limit.FALLEN,)

    @property
    def zmp_depth(self) -> float:
        """How far its planned ZMP lay inside the soles that carry it [m]."""
        return self._engine.zmp_depth

    @property
    def down(self) -> bool:
        """Whether the robot lies or gets up, and obeys no command."""
        return self.get_up is not None

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """One control tick.

        Args:
            sensors: read at the start of the tick.
            command: velocity or footsteps wanted; not obeyed while the robot is down.
            head: direction to look; straight ahead while the robot is down.

        Returns:
            setpoints of all joints.
        """
        get_up, self._command = self.get_up, command
        if get_up is None:
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
        """Snapshot after the last tick; it changes nothing.

        Raises:
            RuntimeError: no tick has been made yet.
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
            command_limits=self.command_limits,
        )

    def _stand(self) -> None:
        """Back to walking, from the ready posture where the robot now stands."""
        p = self._parameters
        self._steps = self.state().step_count
        self._odometry.interrupt(p.get_up.displacement_sigma, p.get_up.yaw_sigma)
        self._engine = WalkingEngine(self._robot, p, self._odometry)
        self.get_up = None
