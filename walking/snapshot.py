"""The engine's state as others see it, in the odometry frame."""

from math import cos, sin

import numpy as np

from walking.gait import Gait
from walking.joints import HEAD
from walking.measurement import BodyMeasurement
from walking.pattern import PendulumState
from walking.robot_model import RobotModel
from walking.sensing import BodySensors
from walking.state import Balance, Footstep, HeadCameraPose, Odometry
from walking.support import Footing
from walking.swing_foot_kernel import RATE


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
        c, s = cos(odometry.yaw), sin(odometry.yaw)
        self.yaw = odometry.yaw + foot.yaw - planned.yaw
        self._c, self._s = cos(self.yaw), sin(self.yaw)
        self._x = odometry.x + c * foot.x - s * foot.y - self._c * planned.x + self._s * planned.y
        self._y = odometry.y + s * foot.x + c * foot.y - self._s * planned.x - self._c * planned.y

    def place(self, x: float, y: float) -> tuple[float, float]:
        """A point of the plan frame in the odometry frame [m]."""
        return self._x + self._c * x - self._s * y, self._y + self._s * x + self._c * y

    def point(self, x: float, y: float) -> np.ndarray:
        """The same as an array (2,) [m]."""
        return np.array(self.place(x, y))

    def vector(self, x: float, y: float) -> np.ndarray:
        """A direction of the plan frame in the odometry frame (2,)."""
        return np.array([self._c * x - self._s * y, self._s * x + self._c * y])

    def footstep(self, step: Footstep) -> Footstep:
        """A foothold of the plan frame in the odometry frame."""
        x, y = self.place(step.x, step.y)
        return Footstep(left=step.left, x=x, y=y, yaw=step.yaw + self.yaw)


def camera_pose(robot: RobotModel, sensors: BodySensors, body: BodyMeasurement) -> HeadCameraPose:
    """Head camera in the robot frame: tilt by IMU, height by the loaded leg."""
    R_BC, p_BC = robot.camera_pose(sensors.joint_position)
    cr, sr, cp, sp = cos(body.roll), sin(body.roll), cos(body.pitch), sin(body.pitch)
    R_RB = np.array([[cp, sp * sr, sp * cr], [0.0, cr, -sr], [-sp, cp * sr, cp * cr]])
    load = body.right_load
    height = -(1.0 - load) * body.feet[0].z - load * body.feet[1].z
    pan, tilt = sensors.joint_position[HEAD].tolist()
    return HeadCameraPose(
        rotation=R_RB @ R_BC,
        position=R_RB @ p_BC + np.array([0.0, 0.0, height]),
        pan=pan,
        tilt=tilt,
    )


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
    polygon = footing.polygon()
    ex, ey, evx, evy = error
    dcm_x = pendulum.x + ex + (pendulum.vx + evx) / omega
    dcm_y = pendulum.y + ey + (pendulum.vy + evy) / omega
    feet = [
        (*plan.place(x, y), height, plan.yaw + yaw)
        for x, y, yaw, height in gait.feet[:, :RATE].tolist()
    ]
    return Balance(
        com=plan.point(pendulum.x, pendulum.y),
        dcm=plan.point(dcm_x, dcm_y),
        support=np.array([plan.place(x, y) for x, y in polygon]),
        zmp_depth=footing.depth(pendulum.zmp_x, pendulum.zmp_y),
        feet=np.array(feet),
        capture=plan.vector(*capture),
    )
