"""Published state of the engine, in the odometry frame."""

import numpy as np

from walking import published_state_kernel
from walking.arrays import Array, Point
from walking.body.measurement import BodyMeasurement
from walking.body.odometry import Odometry
from walking.body.robot_model import RobotModel
from walking.foothold import Foothold
from walking.gait.gait import Gait
from walking.pattern.pendulum import PendulumState
from walking.pattern.support import SupportPolygon
from walking.sensing import BodySensors
from walking.state import Balance, HeadCameraPose
from walking.value import value


@value
class PublishedPlan:
    """Plan in the odometry frame, see `WalkingState`.

    Attributes:
        footsteps, zmp, dcm, com, balance: see `WalkingState`.
    """

    footsteps: tuple[Foothold, ...]
    zmp: Array
    dcm: Array
    com: Array
    balance: Balance


def camera_pose(robot: RobotModel, sensors: BodySensors, body: BodyMeasurement) -> HeadCameraPose:
    """Return the head camera in the robot frame: tilt by IMU, height by the loaded leg."""
    R_BC, p_BC = robot.neck.camera_pose(sensors.joint_position)
    rotation, position = np.empty((3, 3)), np.empty(3)
    yaw_rate = published_state_kernel.level_camera(
        (body.roll, body.pitch), R_BC, p_BC, sensors.gyro, rotation, position
    )
    load = body.right_load
    position[2] += -(1.0 - load) * body.feet[0].z - load * body.feet[1].z
    angles, rates = (
        robot.neck.angles(sensors.joint_position),
        robot.neck.rates(sensors.joint_velocity),
    )
    return HeadCameraPose(rotation, position, *angles, *rates, yaw_rate)


def published_plan(
    gait: Gait,
    pendulum: PendulumState,
    body: BodyMeasurement,
    odometry: Odometry,
    *,
    error: tuple[float, float, float, float],
    omega: float,
    polygon: SupportPolygon,
    capture: Point,
) -> PublishedPlan:
    """Express the plan in the odometry frame: its support foot is where odometry measures it.

    Args:
        gait: references of the feet, and planned footsteps.
        pendulum: planned motion.
        body: measurement.
        odometry: pose of the robot frame.
        error: of the body against the plan, x, y [m], vx, vy [m/s].
        omega: of the pendulum [1/s].
        polygon: support polygon.
        capture: shift of the landing by the capture step, plan frame [m].
    """
    edges, footsteps = polygon.edges(), gait.footsteps()
    points, feet = np.empty((5 + len(edges), 2)), np.empty((2, 4))
    support, foot = gait.footholds[gait.support], body.feet[gait.support]
    turned = published_state_kernel.show(
        support.frame,
        (foot.x, foot.y, foot.yaw),
        (odometry.x, odometry.y, odometry.yaw),
        pendulum.row,
        error,
        omega,
        body.com,
        edges,
        gait.feet,
        capture,
        points,
        feet,
        footsteps,
    )
    return PublishedPlan(
        footsteps=tuple(map(Foothold.from_row, footsteps.tolist())),
        zmp=points[0],
        dcm=points[1],
        com=points[4],
        balance=Balance(
            com=points[2],
            dcm=points[3],
            support=points[5:],
            zmp_depth=polygon.depth(*pendulum.zmp),
            feet=feet,
            capture=np.array(turned),
        ),
    )
