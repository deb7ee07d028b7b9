"""From references of pelvis and feet to joint angles and feed-forward."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from walking import leg_kernel
from walking.arms import arm_swing
from walking.gait import Gait
from walking.leg_kinematics import foot_pose
from walking.parameters import WalkingParameters
from walking.robot_model import RobotModel
from walking.state import Footstep

Array = NDArray[np.float64]


@dataclass(slots=True)
class Pelvis:
    """Where the body is meant to be in the plan frame.

    Attributes:
        x, y: pelvis above the floor [m].
        yaw: heading of the trunk [rad].
    """

    x: float
    y: float
    yaw: float


class Posture:
    """Joint angles of the whole body.

    Args:
        robot: dimensions.
        parameters: heights, arms, tilt compensation.
    """

    def __init__(self, robot: RobotModel, parameters: WalkingParameters) -> None:
        self._com_ahead = float(robot.com(robot.ready)[0])
        self._ready = robot.ready
        self._legs = robot.leg_rows
        self._arms = parameters.arms
        p = parameters.stabilizer
        height = parameters.pattern.pelvis_height - robot.legs[0].hip_z
        self._law = (p.tilt_gain, p.tilt_dead_zone, p.tilt_pull, p.tilt_decay, height)
        self._tilt = np.zeros((2, 2))

    def pelvis(self, gait: Gait, com: tuple[float, float]) -> Pelvis:
        """Pelvis that puts its constant offset point onto the pendulum."""
        left, right = gait.feet
        yaw = 0.5 * (left.yaw.position + right.yaw.position)
        return Pelvis(
            x=com[0] - self._com_ahead * cos(yaw), y=com[1] - self._com_ahead * sin(yaw), yaw=yaw
        )

    def joints(
        self,
        gait: Gait,
        pelvis: Pelvis,
        tilt: tuple[float, float],
        head: tuple[float, float],
    ) -> Array:
        """Joint angles (26,) [rad].

        Args:
            gait: feet.
            pelvis: of this tick.
            tilt: measured roll and pitch of the trunk [rad].
            head: pan and tilt [rad].
        """
        left, right = gait.feet
        position = self._ready.copy()
        apart = leg_kernel.pose_legs(
            position,
            self._tilt,
            (left.row, right.row),
            (gait.support, gait.swing if gait.flying else -1),
            (pelvis.x, pelvis.y, pelvis.yaw),
            tilt,
            self._law,
            self._legs,
        )
        swing = arm_swing(apart, self._arms)
        position[12], position[13] = head
        position[14] += swing
        position[20] -= swing
        return position


def ready_stance(robot: RobotModel) -> tuple[Footstep, Footstep]:
    """Feet of the ready posture; the plan frame has its origin under the hips."""
    a, b, c, d, e, f = robot.ready[:6].tolist()
    left = foot_pose(robot.legs[0], (a, b, c, d, e, f))
    a, b, c, d, e, f = robot.ready[6:12].tolist()
    right = foot_pose(robot.legs[1], (a, b, c, d, e, f))
    return (
        Footstep(left=True, x=left.x, y=left.y, yaw=left.yaw),
        Footstep(left=False, x=right.x, y=right.y, yaw=right.yaw),
    )
