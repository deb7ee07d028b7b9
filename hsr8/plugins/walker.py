"""User-defined walkers: copied sensors in, validated setpoints out, and hsr8's state estimation.

Vision, belief and navigation need odometry, camera pose and gait under any walker. They are
measured, because a user-defined walker publishes no plan.
"""

from copy import deepcopy
from math import inf
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compilation.value import value
from hsr8.errors import UsageError
from hsr8.plugins.file import start_plugin
from hsr8.plugins.method import PluginMethod, numbers, shown
from walking.body.robot_model import RobotModel
from walking.command import Command, HeadTarget, Limit, VelocityCommand
from walking.estimate.odometry import LegOdometry
from walking.observer import BodyEstimate, BodyObserver, Head
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.state import BodySensors, JointTargets, WalkingState

Array = NDArray[np.float64]

STEP = "step(sensors, command, head, estimate)"


@value
class RobotInfo:
    """Robot that a user-defined walker moves.

    Attributes:
        joint_names: names in the order of all joint arrays, n in all.
        ready: joint angles of the ready posture, in which a walk starts (n,) [rad].
        lower, upper: joint limits (n,) [rad].
        head: indices of the head joints, pan and tilt; empty without a movable head.
        period: period of control [s].
        file: MJCF or URDF file of the robot.
    """

    joint_names: tuple[str, ...]
    ready: Array
    lower: Array
    upper: Array
    head: list[int]
    period: float
    file: Path

    @classmethod
    def of(cls, robot: RobotModel, file: Path) -> "RobotInfo":
        """Return the description of `robot`, read from `file`."""
        return cls(
            joint_names=robot.names,
            ready=robot.ready.copy(),
            lower=robot.lower.copy(),
            upper=robot.upper.copy(),
            head=list(robot.tree.head or ()),
            period=CONTROL_PERIOD,
            file=file,
        )


class CustomWalker(Protocol):
    """User-defined walker; may also have the methods ``start(robot)`` and ``reset()``.

    `start` receives the `RobotInfo` before a run. `reset` precedes the first tick, and the first
    tick after getting up from a fall: the robot stands in the ready posture.
    """

    def step(
        self,
        sensors: BodySensors,
        command: VelocityCommand,
        head: Array,
        estimate: BodyEstimate,
    ) -> ArrayLike:
        """Return the setpoints of all joints for one control tick (n,) [rad].

        Args:
            sensors: read at the start of the tick.
            command: velocity of the robot frame; explicit footsteps arrive as their velocity.
            head: setpoints of the head joints, limited in rate and acceleration (2,) [rad]; empty
                without a movable head.
            estimate: motion of the trunk.
        """


class PluginWalker:
    """User-defined walker with copied inputs and validated setpoints.

    Args:
        walker: user-defined walker.
        robot: description of the robot.

    Raises:
        UsageError: `walker` has no method step, or its start failed; from `step`: the setpoints
            are invalid.
    """

    def __init__(self, walker: CustomWalker, robot: RobotInfo) -> None:
        self._step = PluginMethod(walker, "walker", STEP, object)
        self._reset = getattr(walker, "reset", None)
        self._joints = len(robot.joint_names)
        start_plugin(walker, self._step.name, robot)

    def reset(self) -> None:
        """Prepare for a walk from the ready posture."""
        if self._reset is not None:
            self._reset()

    def step(
        self,
        sensors: BodySensors,
        command: VelocityCommand,
        head: Array,
        estimate: BodyEstimate,
    ) -> Array:
        """Return the validated setpoints of this tick (n,) [rad]."""
        returned = self._step(deepcopy(sensors), command, head, estimate)
        setpoints = numbers(returned)
        if setpoints is None or setpoints.shape != (self._joints,):
            problem = f"must return {self._joints} joint setpoints [rad], got {shown(returned)}"
            raise UsageError(f"{self._step.name}: {STEP} {problem}")
        if not np.isfinite(setpoints).all():
            raise UsageError(
                f"{self._step.name}: {STEP} must return finite joint setpoints [rad], got "
                f"{shown(returned)}"
            )
        return setpoints


class PluginEngine:
    """Walking engine of a user-defined walker: its setpoints, and the measured state.

    Args:
        walker: user-defined walker.
        robot: model of the robot.
        parameters: parameters of the state estimation and the head.
        odometry: dead reckoning to continue.
    """

    def __init__(
        self,
        walker: PluginWalker,
        robot: RobotModel,
        parameters: WalkingParameters,
        odometry: LegOdometry,
    ) -> None:
        self._walker = walker
        self._lower, self._upper = robot.lower, robot.upper
        self._observer = BodyObserver(robot, parameters, odometry)
        self._head = Head(robot, parameters)
        self._command: VelocityCommand | None = None

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that limited the last command: none are known."""
        return ()

    @property
    def zmp_depth(self) -> float:
        """Depth of the planned ZMP inside the support polygon: infinite without a plan [m]."""
        return inf

    @property
    def fallen(self) -> bool:
        """Whether the tilt of the trunk is that of a fallen robot."""
        return self._observer.fallen

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """Run one control tick.

        Raises:
            UsageError: the walker returned invalid setpoints.
        """
        if self._command is None:
            self._walker.reset()
        self._command = VelocityCommand(*command.velocity)
        estimate = self._observer.update(sensors)
        angles = self._head.advance(head)
        setpoints = self._walker.step(sensors, self._command, angles, estimate)
        setpoints = np.clip(setpoints, self._lower, self._upper)
        return JointTargets(position=setpoints, setpoint=setpoints)

    def observe(self, sensors: BodySensors) -> None:
        """Update only the attitude in a tick in which something else moves the joints."""
        self._observer.observe(sensors)

    def state(self) -> WalkingState:
        """Return the measured state after the last tick.

        Raises:
            RuntimeError: before the first tick.
        """
        return self._observer.state(self._command or VelocityCommand())
