"""Inverse kinematics of the whole body from pelvis and foot references."""

import numpy as np

from walking.arrays import Array, Point, Vector
from walking.body import leg_kernel
from walking.body.leg_kinematics import foot_pose
from walking.body.robot_model import RobotModel
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
    """

    def __init__(self, robot: RobotModel, parameters: WalkingParameters) -> None:
        arms, ahead = parameters.arms, float(robot.com(robot.ready)[0])
        self._build = np.array([ahead, arms.swing_gain, arms.max_swing])
        self._ahead = ahead
        self._ready = robot.ready
        self._legs = robot.leg_rows
        p = parameters.stabilizer
        self.height = parameters.pattern.pelvis_height - robot.legs[0].hip_z
        tilt_control = p.tilt_gain, p.tilt_dead_zone, p.tilt_pull, p.tilt_decay, self.height
        self._tilt_control = np.array(tilt_control)
        self._tilt = np.zeros((2, 2))

    def pelvis(self, gait: Gait, com: Point) -> Vector:
        """Return the pelvis, x, y [m], heading [rad], with the nominal centre of mass at `com` [m].

        The nominal centre of mass is fixed ahead of the base.
        """
        return leg_kernel.pelvis_of(gait.feet, com, self._ahead)

    def joints(self, gait: Gait, com: Point, tilt: Point, head: Point) -> tuple[Array, Vector]:
        """Return the joint angles (26,) [rad] and the pelvis, x, y [m], heading [rad].

        Args:
            gait: feet.
            com: planned centre of mass, in the plan frame [m].
            tilt: measured roll and pitch of the trunk [rad].
            head: pan and tilt [rad].
        """
        position = self._ready.copy()
        pelvis = leg_kernel.pose(
            position,
            self._tilt,
            gait.feet,
            (gait.support, gait.swing if gait.airborne else -1),
            com,
            head,
            tilt,
            self._tilt_control,
            self._build,
            self._legs,
        )
        return position, pelvis


def ready_stance(robot: RobotModel) -> tuple[Foothold, Foothold]:
    """Return the feet in the ready posture; the plan frame has its origin under the hips."""
    a, b, c, d, e, f = robot.ready[:6].tolist()
    left = foot_pose(robot.legs[0], (a, b, c, d, e, f))
    a, b, c, d, e, f = robot.ready[6:12].tolist()
    right = foot_pose(robot.legs[1], (a, b, c, d, e, f))
    return (
        Foothold(left=True, x=left.x, y=left.y, yaw=left.yaw),
        Foothold(left=False, x=right.x, y=right.y, yaw=right.yaw),
    )
