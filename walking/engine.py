"""Walking engine: sensors and commands to joint targets, once per control tick."""

from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from compilation.record import Records, records
from walking.body.robot_model import RobotModel
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.command import Command, CommandState, HeadTarget, Limit, VelocityCommand, limits_of
from walking.constants import joint_records, robot_record
from walking.data import Data
from walking.estimate.odometry import LegOdometry
from walking.parameters import WalkingParameters
from walking.plan.footsteps import StepValues
from walking.plan.gait import right_weight
from walking.plane import Array
from walking.published import Published, publish, walking_state
from walking.state import BodySensors, JointTargets, WalkingState
from walking.walk import Parts, measure_body, plan_tick, set_setpoints, stand_ready

SIZE = np.dtype(Published).itemsize  # of the published state [bytes]


class PlanDiverged(Exception):
    """The planned motion diverged: the pendulum left the feet, and no walk can follow it."""


class WalkingEngine:
    """Walking engine of a humanoid: call `step` once per control tick of 5 ms.

    The engine starts in the ready posture, stands until a command moves it, and stops with the feet
    side by side. All its state is in records, see `walking.data`; a tick is `walking.walk`.

    Args:
        robot: model of the robot.
        parameters: parameters of the engine.
        odometry: dead reckoning to continue; starts at the origin by default.
    """

    def __init__(
        self, robot: RobotModel, parameters: WalkingParameters, odometry: LegOdometry | None = None
    ) -> None:
        self._robot = robot = robot.with_own_buffers()
        self._robots = robot_record(robot, parameters)
        self._joints = joint_records(robot, parameters)
        self._odometry = odometry or LegOdometry(parameters.odometry)
        self._walks = records(Data)
        self._walk, dynamics = self._walks[0], robot.dynamics
        motion = (dynamics.q, dynamics.v, dynamics.a)
        self._parts = Parts(self._joints, robot.links, robot.order, *motion)
        self._command: Command = VelocityCommand()
        self._sensors: BodySensors | None = None
        self._fallen = False
        self._stand(robot)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that limited the last command."""
        return limits_of(int(self._walk.limits))

    @property
    def zmp_depth(self) -> float:
        """Distance of the last planned ZMP from the edge of the support polygon [m]."""
        return float(self._walk.zmp_depth)

    @property
    def heading(self) -> float:
        """Planned heading of the trunk [rad]."""
        return float(self._walk.limbs.pelvis.yaw)

    @property
    def load(self) -> float:
        """Planned load fraction of the right foot [1]."""
        return right_weight(self._walk.plan.gait)

    @property
    def leg_angles(self) -> Array:
        """Planned angles of the leg joints, also beyond their limits (12,) [rad]."""
        return self._walk.limbs.leg_angles.copy()

    @property
    def torques(self) -> Array:
        """Planned torques of all joints in the last tick (n,) [N m]."""
        joints = cast("NDArray[Any]", self._joints)
        lag = joints["rate_ahead"] * joints["lag"]
        torques: Array = (joints["offset"] - lag) / joints["compliance"]
        return torques

    @property
    def fallen(self) -> bool:
        """Whether the tilt of the trunk is that of a fallen robot."""
        return self._fallen

    def step(self, sensors: BodySensors, command: Command, head: HeadTarget) -> JointTargets:
        """Run one control tick.

        Args:
            sensors: read at the start of the tick.
            command: velocity or footsteps, new in any tick; limited, see `CommandLimits`.
            head: gaze direction, limited by rate, acceleration and joint limits.

        Returns:
            setpoints of all joints.

        Raises:
            PlanDiverged: the planned centre of mass is far from the feet, since the sensors
                contradict the plan for long.
        """
        self.observe(sensors)
        self._command = command
        angles, setpoint = np.empty((2, len(self._joints)))
        distance = plan_tick(
            self._walks,
            self._odometry.records,
            self._robots,
            self._parts,
            angles,
            *_values(command),
            (head.pan, head.tilt),
        )
        if distance != 0.0:
            raise PlanDiverged(
                f"the planned walk diverged: the centre of mass is {distance:.3g} m from the feet"
            )
        set_setpoints(
            self._walks,
            self._robots,
            self._joints,
            self._robot.dynamics.forces(),
            sensors.gyro,
            angles,
            sensors.joint_position,
            setpoint,
        )
        return JointTargets(position=angles, setpoint=setpoint)

    def observe(self, sensors: BodySensors) -> None:
        """Measure the body only, in a tick in which something else moves the joints."""
        self._sensors = sensors
        self._fallen = measure_body(self._walks, sensors, self._robot, self._robots)

    def state(self) -> WalkingState:
        """Return the state after the last tick.

        Raises:
            RuntimeError: before the first tick.
        """
        sensors = self._sensors
        if sensors is None:
            raise RuntimeError("the walking engine has no state before its first tick")
        # A record over given bytes is made in a fifth of the time of `np.zeros(1, Published)`.
        published = cast("Records[Published]", np.ndarray(1, Published, np.zeros(SIZE, np.uint8)))
        publish(
            published,
            self._walks,
            self._odometry.records,
            self._robots,
            sensors.joint_velocity,
            sensors.gyro,
        )
        return walking_state(published, self._command)

    def _stand(self, robot: RobotModel) -> None:
        """Set the state of a robot that stands in the ready posture."""
        limbs = self._walk.limbs
        limbs.com_x, limbs.com_y, _ = robot.com(robot.ready).tolist()
        limbs.leg_angles[:] = robot.ready[:12]
        limbs.pan, limbs.tilt = robot.neck.angles(robot.ready)
        stand_ready(self._walks, _ready_stance(robot), self._robots)


def _ready_stance(robot: RobotModel) -> Array:
    """Return x, y [m] and yaw [rad] of the feet; the plan frame has its origin under the hips."""
    feet = [
        leg.pose(robot.ready[part])
        for leg, part in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True)
    ]
    return np.array([(foot.x, foot.y, foot.yaw) for foot in feet])


def _values(command: Command) -> tuple[StepValues, bool]:
    """Return the numbers of a command, and whether it is a command state."""
    if isinstance(command, CommandState):
        c = command
        supports = c.single_support, c.double_support
        return (*supports, c.forward, c.side, c.direction, c.swing_height), True
    return (command.vx, command.vy, command.wz, 0.0, 0.0, 0.0), False
