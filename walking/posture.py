"""From references of pelvis and feet to joint angles and feed-forward."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from walking.arms import arm_swing
from walking.gait import Gait
from walking.joints import HEAD
from walking.leg_kinematics import FootPose, LegAngles, foot_pose, leg_angles
from walking.parameters import WalkingParameters
from walking.robot_model import RobotModel
from walking.saturation import beyond
from walking.state import Footstep
from walking.swing import FootReference

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
        self._robot = robot
        self._height = parameters.pattern.pelvis_height - robot.legs[0].hip_z
        self._com_ahead = robot.com(robot.ready)[0]
        self._ready: list[float] = robot.ready.tolist()
        self._arms = parameters.arms
        self._stabilizer = parameters.stabilizer
        self._tilt = [[0.0, 0.0], [0.0, 0.0]]

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
    ) -> tuple[list[float], tuple[LegAngles, LegAngles]]:
        """Joint angles (26,) [rad], and those of the two legs.

        Args:
            gait: feet.
            pelvis: of this tick.
            tilt: measured roll and pitch of the trunk [rad].
            head: pan and tilt [rad].
        """
        c, s = cos(pelvis.yaw), sin(pelvis.yaw)
        support = gait.feet[gait.support]
        legs = []
        for index, foot in enumerate(gait.feet):
            self._follow_tilt(gait, index, tilt)
            legs.append(self._leg(index, foot, support, pelvis, (c, s)))
        left, right = gait.feet
        apart = c * (left.x.position - right.x.position) + s * (left.y.position - right.y.position)
        swing = arm_swing(apart, self._arms)
        angles = [*legs[0], *legs[1], *self._ready[12:]]
        angles[HEAD] = head
        angles[14] += swing
        angles[20] -= swing
        return angles, (legs[0], legs[1])

    def _leg(
        self,
        index: int,
        foot: FootReference,
        support: FootReference,
        pelvis: Pelvis,
        heading: tuple[float, float],
    ) -> LegAngles:
        c, s = heading
        dx, dy = foot.x.position - pelvis.x, foot.y.position - pelvis.y
        x, y = c * dx + s * dy, c * dy - s * dx
        yaw = foot.yaw.position - pelvis.yaw
        roll, pitch = self._tilt[index]
        height = foot.height
        if roll != 0.0 or pitch != 0.0:
            ax, ay = foot.x.position - support.x.position, foot.y.position - support.y.position
            height += pitch * (c * ax + s * ay) - roll * (c * ay - s * ax)
        cf, sf = cos(yaw), sin(yaw)
        pose = FootPose(
            x=x,
            y=y,
            z=height - self._height,
            roll=-(cf * roll + sf * pitch),
            pitch=-(cf * pitch - sf * roll),
            yaw=yaw,
        )
        return leg_angles(self._robot.legs[index], pose)[0]

    def _follow_tilt(self, gait: Gait, index: int, tilt: tuple[float, float]) -> None:
        """A foot in the air stays level with the floor although the trunk is not."""
        p, own = self._stabilizer, self._tilt[index]
        flying = gait.stepping and index == gait.swing and not gait.double and not gait.held
        if flying and 0.0 < gait.swing_phase < 1.0:
            for axis in (0, 1):
                wanted = p.tilt_gain * beyond(tilt[axis], p.tilt_dead_zone)
                own[axis] += p.tilt_pull * (wanted - own[axis])
        elif own[0] != 0.0 or own[1] != 0.0:
            for axis in (0, 1):
                own[axis] *= p.tilt_decay
                if abs(own[axis]) < 1e-6:
                    own[axis] = 0.0


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
