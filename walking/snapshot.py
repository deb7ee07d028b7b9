"""The engine's state as others see it, in the odometry frame."""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from walking import snapshot_kernel
from walking.gait import Gait
from walking.joints import HEAD
from walking.measurement import BodyMeasurement
from walking.pattern import PendulumState
from walking.robot_model import RobotModel
from walking.sensing import BodySensors
from walking.state import Balance, Footstep, HeadCameraPose, Odometry, foothold
from walking.support import Footing
from walking.swing_foot_kernel import HEIGHT

Array = NDArray[np.float64]
Point = tuple[float, float]

YAW = 2  # column of a foot's direction


class PlanToOdometry:
    """Rigid transform that puts the planned support foot where odometry sees it.

    Args:
        planned: support foot in the plan frame.
        body: measured body.
        support: index of the support foot.
        odometry: pose of the robot frame.
    """

    def __init__(
        self, planned: Footstep, body: BodyMeasurement, support: int, odometry: Odometry
    ) -> None:
        foot = body.feet[support]
        self._frame = snapshot_kernel.frame_of(
            (planned.x, planned.y, planned.yaw),
            (foot.x, foot.y, foot.yaw),
            (odometry.x, odometry.y, odometry.yaw),
        )

    def points(self, points: Sequence[Point]) -> Array:
        """Points of the plan frame in the odometry frame (n, 2) [m]."""
        table = np.array(points)
        snapshot_kernel.place(self._frame, table, -1)
        return table

    def vector(self, x: float, y: float) -> Array:
        """A direction of the plan frame in the odometry frame (2,)."""
        return np.array(snapshot_kernel.turn(self._frame, (x, y)))

    def footsteps(self, rows: Array) -> tuple[Footstep, ...]:
        """Footholds of the plan frame, see `Footstep.row`, in the odometry frame."""
        table = rows.copy()
        snapshot_kernel.place(self._frame, table, YAW)
        return tuple(foothold(row) for row in table.tolist())

    def feet(self, feet: Array) -> Array:
        """References of the feet as `Balance` has them (2, 4)."""
        table = feet.take((0, 1, HEIGHT, YAW), axis=1)
        snapshot_kernel.place(self._frame, table, 3)
        return table


def camera_pose(robot: RobotModel, sensors: BodySensors, body: BodyMeasurement) -> HeadCameraPose:
    """Head camera in the robot frame: tilt by IMU, height by the loaded leg."""
    R_BC, p_BC = robot.camera_pose(sensors.joint_position)
    cr, sr, cp, sp = cos(body.roll), sin(body.roll), cos(body.pitch), sin(body.pitch)
    R_RB = np.array([[cp, sp * sr, sp * cr], [0.0, cr, -sr], [-sp, cp * sr, cp * cr]])
    load = body.right_load
    position = R_RB @ p_BC
    position[2] += -(1.0 - load) * body.feet[0].z - load * body.feet[1].z
    pan, tilt = sensors.joint_position[HEAD].tolist()
    return HeadCameraPose(rotation=R_RB @ R_BC, position=position, pan=pan, tilt=tilt)


def balance(
    plan: PlanToOdometry,
    gait: Gait,
    pendulum: PendulumState,
    *,
    error: tuple[float, float, float, float],
    omega: float,
    footing: Footing,
    capture: tuple[float, float],
) -> Balance:
    """Planned and measured motion of one tick in the odometry frame.

    Args:
        plan: transform from the plan frame.
        gait: references of the feet.
        pendulum: planned motion.
        error: of the body against it, x, y [m], vx, vy [m/s].
        omega: of the pendulum [1/s].
        footing: soles that carry.
        capture: what balance adds to the landing, plan frame [m].
    """
    ex, ey, evx, evy = error
    x, y = pendulum.x, pendulum.y
    dcm = x + ex + (pendulum.vx + evx) / omega, y + ey + (pendulum.vy + evy) / omega
    placed = plan.points([(x, y), dcm, *footing.polygon()])
    return Balance(
        com=placed[0],
        dcm=placed[1],
        support=placed[2:],
        zmp_depth=footing.depth(pendulum.zmp_x, pendulum.zmp_y),
        feet=plan.feet(gait.feet),
        capture=plan.vector(*capture),
    )
