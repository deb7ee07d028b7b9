"""Inverse kinematics of the whole body from pelvis and foot references."""

import numpy as np

from walking.arrays import Array, Point, Vector
from walking.body import kinematics_kernel
from walking.body.robot_model import RobotModel
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.foothold import Foothold
from walking.gait.gait import Gait
from walking.parameters import WalkingParameters


class Posture:
    """Inverse kinematics of the whole body.

    Args:
        robot: dimensions.
        parameters: heights, arms, tilt compensation of the swing foot.

    Attributes:
        height: of the base above the floor [m].
        legs: axes (2, 6, 3) and origins (2, 6, 3) [m] of the leg joints in the base frame, in the
            last posture.
        angles: of the legs in the last posture, also beyond their limits (2, 6) [rad].
        error: of the legs in the last posture, see `kinematics_kernel.pose` [rad].
    """

    def __init__(self, robot: RobotModel, parameters: WalkingParameters) -> None:
        arms, ahead = parameters.arms, float(robot.com(robot.ready)[0])
        length = robot.legs[0].length
        signs = robot.shoulder_signs()
        self._build = np.array([ahead, arms.swing_gain, arms.max_swing, *signs, length])
        self._ahead = ahead
        self._ready = robot.ready
        none = (-1, -1)
        self._moved = np.array([*(robot.tree.head or none), *(robot.tree.shoulders or none)])
        self._chains, self._limits = robot.chains, np.array([robot.lower, robot.upper])
        self._reach = np.array([leg.reach for leg in robot.legs])
        self.angles = np.array([robot.ready[LEFT_LEG], robot.ready[RIGHT_LEG]])
        self.legs = np.zeros((2, 6, 3)), np.zeros((2, 6, 3))
        self.error = 0.0
        p = parameters.stabilizer
        self.height = parameters.pattern.pelvis_height - robot.legs[0].hip[2]
        tilt_control = p.tilt_gain, p.tilt_dead_zone, p.tilt_pull, p.tilt_decay, self.height
        self._tilt_control = np.array(tilt_control)
        self._tilt = np.zeros((2, 2))

    def pelvis(self, gait: Gait, com: Point) -> Vector:
        """Return the pelvis, x, y [m], heading [rad], with the nominal centre of mass at `com` [m].

        The nominal centre of mass is fixed ahead of the base.
        """
        return kinematics_kernel.pelvis_of(gait.feet, com, self._ahead)

    def joints(self, gait: Gait, com: Point, tilt: Point, head: Point) -> tuple[Array, Vector]:
        """Return the joint angles (n,) [rad] and the pelvis, x, y [m], heading [rad].

        Args:
            gait: feet.
            com: planned centre of mass, in the plan frame [m].
            tilt: measured roll and pitch of the trunk [rad].
            head: angles of the head joints [rad].
        """
        position = self._ready.copy()
        pelvis, self.error = kinematics_kernel.pose(
            position,
            self.angles,
            self._tilt,
            gait.feet,
            (gait.support, gait.swing if gait.airborne else -1),
            com,
            head,
            tilt,
            self._tilt_control,
            self._build,
            self._moved,
            self._chains,
            self._reach,
            self._limits,
            *self.legs,
        )
        return position, pelvis


def ready_stance(robot: RobotModel) -> tuple[Foothold, Foothold]:
    """Return the feet in the ready posture; the plan frame has its origin under the hips."""
    left, right = (
        leg.pose(robot.ready[part])
        for leg, part in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True)
    )
    return (
        Foothold(left=True, x=left.x, y=left.y, yaw=left.yaw),
        Foothold(left=False, x=right.x, y=right.y, yaw=right.yaw),
    )
