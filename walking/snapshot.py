"""The engine's state as others see it, in the odometry frame."""

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
from walking.value import value

Array = NDArray[np.float64]
Point = tuple[float, float]

BALANCE = np.array([0, 1, HEIGHT, 2])  # columns of a foot's reference as `Balance` has them


@value
class PlanSeen:
    """What a snapshot tells of the plan, all of it in the odometry frame; see `WalkingState`.

    Attributes:
        footsteps: planned footholds, the support foot first.
        zmp: planned zero-moment point (2,) [m].
        dcm: planned divergent component of motion (2,) [m].
        balance: planned and measured motion in detail.
    """

    footsteps: tuple[Footstep, ...]
    zmp: Array
    dcm: Array
    balance: Balance


def camera_pose(robot: RobotModel, sensors: BodySensors, body: BodyMeasurement) -> HeadCameraPose:
    """Head camera in the robot frame: tilt by IMU, height by the loaded leg."""
    R_BC, p_BC = robot.camera_pose(sensors.joint_position)
    cr, sr, cp, sp = cos(body.roll), sin(body.roll), cos(body.pitch), sin(body.pitch)
    R_RB = np.array([[cp, sp * sr, sp * cr], [0.0, cr, -sr], [-sp, cp * sr, cp * cr]])
    load = body.right_load
    position = R_RB @ p_BC
    position[2] += -(1.0 - load) * body.feet[0].z - load * body.feet[1].z
    pan, tilt = sensors.joint_position[HEAD].tolist()
    pan_rate, tilt_rate = sensors.joint_velocity[HEAD].tolist()
    return HeadCameraPose(R_RB @ R_BC, position, pan, tilt, pan_rate, tilt_rate)


def plan_seen(
    gait: Gait,
    pendulum: PendulumState,
    body: BodyMeasurement,
    odometry: Odometry,
    *,
    error: tuple[float, float, float, float],
    omega: float,
    footing: Footing,
    capture: Point,
) -> PlanSeen:
    """The plan where the planned support foot stands as odometry sees it.

    Args:
        gait: references of the feet, and the footsteps to come.
        pendulum: planned motion.
        body: as measured.
        odometry: pose of the robot frame.
        error: of the body against the plan, x, y [m], vx, vy [m/s].
        omega: of the pendulum [1/s].
        footing: soles that carry.
        capture: what balance adds to the landing, plan frame [m].
    """
    ex, ey, evx, evy = error
    x, y, vx, vy = pendulum.x, pendulum.y, pendulum.vx, pendulum.vy
    zmp = (pendulum.zmp_x, pendulum.zmp_y)
    planned = (x + vx / omega, y + vy / omega)
    measured = (x + ex + (vx + evx) / omega, y + ey + (vy + evy) / omega)
    points = np.array([zmp, planned, (x, y), measured, *footing.polygon()])
    feet = gait.feet.take(BALANCE, axis=1)
    footsteps = gait.footsteps()
    support, foot = gait.footholds[gait.support], body.feet[gait.support]
    turned = snapshot_kernel.bring_over(
        (support.x, support.y, support.yaw),
        (foot.x, foot.y, foot.yaw),
        (odometry.x, odometry.y, odometry.yaw),
        points,
        feet,
        footsteps,
        capture,
    )
    return PlanSeen(
        footsteps=tuple(map(foothold, footsteps.tolist())),
        zmp=points[0],
        dcm=points[1],
        balance=Balance(
            com=points[2],
            dcm=points[3],
            support=points[4:],
            zmp_depth=footing.depth(*zmp),
            feet=feet,
            capture=np.array(turned),
        ),
    )
