"""Joint targets of the whole body from pendulum and feet."""

import numpy as np

from walking.arrays import Array, Point
from walking.body.robot_model import RobotModel
from walking.body.tree import RIGHT_LEG
from walking.gait.gait import Gait
from walking.gait.swing_reaction import SwingCompensation, leg_reaction
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.planar import rotate
from walking.servos.feedforward import FeedForward
from walking.servos.posture import Posture
from walking.targets import JointTargets


class WholeBody:
    """Moves the pelvis with the pendulum and computes the joint targets.

    Args:
        robot: model of the robot.
        parameters: of the engine.
        lipm: pendulum.
        gait: foot references.
        pendulum: planned centre of mass.

    Attributes:
        pelvis: of the last tick, x, y [m], heading [rad] in the plan frame.
        turn_rate: planned, of the trunk [rad/s].
        com: centre of mass of the last posture in the base frame, x, y [m].
        compensation: motion of the pelvis against the reaction of the swing leg.
    """

    def __init__(
        self,
        robot: RobotModel,
        parameters: WalkingParameters,
        *,
        lipm: Lipm,
        gait: Gait,
        pendulum: PendulumState,
    ) -> None:
        self._robot = robot
        self._w2 = lipm.omega * lipm.omega
        self._gait = gait
        self._pendulum = pendulum
        self._posture = Posture(robot, parameters)
        base = self._posture.height
        self._feedforward = FeedForward(robot, parameters.stabilizer, base)
        self.compensation = SwingCompensation(
            lipm, leg_reaction(robot, base, parameters.gait.swing_height)
        )
        self.pelvis = self._posture.pelvis(gait, (pendulum.x, pendulum.y))
        self.turn_rate = 0.0
        x, y, _ = robot.com(robot.ready).tolist()
        self.com: Point = x, y

    @property
    def leg_angles(self) -> Array:
        """Planned angles of the leg joints, also beyond their limits (12,) [rad]."""
        return self._posture.angles.flatten()

    @property
    def torques(self) -> Array:
        """Planned torques of all joints in the last tick (n,) [N m]."""
        return self._feedforward.torques()

    def follow(
        self,
        tilt: Point,
        gyro: Array,
        zmp: Point,
        zmp_shift: Point,
        right_load: float,
        *,
        measured: Array,
        head: Point,
        offset: Point,
    ) -> JointTargets:
        """Return the joint targets of a tick.

        Args:
            tilt: measured roll and pitch of the trunk [rad].
            gyro: angular velocity of the trunk (3,) [rad/s].
            zmp: planned [m].
            zmp_shift: of the ankles [m].
            right_load: planned load fraction of the right foot [1].
            measured: joint angles (n,) [rad].
            head: angles of the head joints [rad].
            offset: of the body from the pendulum, forward and left [m].
        """
        gait, pendulum = self._gait, self._pendulum
        before = self.pelvis[2]
        compensation = self.compensation
        compensation.advance(gait.swings())
        (ox, oy), (ex, ey) = compensation.offset, compensation.acceleration
        dx, dy = rotate(before, *offset)
        com = pendulum.x + (ox + dx), pendulum.y + (oy + dy)
        position, pelvis = self._posture.joints(gait, com, tilt, head)
        self.pelvis, self.turn_rate = pelvis, (pelvis[2] - before) / CONTROL_PERIOD
        w2 = self._w2
        offsets = self._feedforward.offsets(
            position,
            pelvis,
            gait.foot_zmps,
            right_load,
            (w2 * (pendulum.x - zmp[0]) + ex, w2 * (pendulum.y - zmp[1]) + ey),
            legs=self._posture.legs,
            task=(zmp_shift, gyro),
        )
        self.com = self._robot.moved_com()
        robot = self._robot
        setpoint = np.minimum(np.maximum(position + offsets, robot.lower), robot.upper)
        if robot.stiffening > 1.0:
            legs = slice(0, RIGHT_LEG.stop)
            setpoint[legs] += (robot.stiffening - 1.0) * (setpoint[legs] - measured[legs])
        return JointTargets(position=position, setpoint=setpoint)
