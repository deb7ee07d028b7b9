"""Transform of the plan into the odometry frame, compiled."""

from math import cos, sin

import numpy as np

from compilation import compiled
from walking.arrays import Array, Point, Vector

Pendulum = tuple[float, float, float, float, float, float]
"""Position x, y [m], velocity x, y [m/s], ZMP x, y [m]."""

Motion = tuple[float, float, float, float]
"""Position x, y [m], velocity x, y [m/s]."""

Frame = tuple[float, float, float, float, float]
"""Origin x, y [m], cosine and sine of the direction, and the direction [rad] of the plan frame."""


@compiled
def show(
    planned: Vector,
    foot: Vector,
    odometry: Vector,
    pendulum: Pendulum,
    error: Motion,
    omega: float,
    com: Vector,
    edges: Array,
    references: Array,
    vector: Point,
    points: Array,
    feet: Array,
    footsteps: Array,
) -> Point:
    """Express the plan in the odometry frame.

    Args:
        planned: see `frame_of`.
        foot: see `frame_of`.
        odometry: see `frame_of`.
        pendulum: of the plan.
        error: of the body against it.
        omega: of the pendulum [1/s].
        com: measured centre of mass in the robot frame (3,) [m].
        edges: of the support polygon, see `walking.pattern.support_kernel` (n, 5).
        references: of the feet, see `walking.gait.swing_foot_kernel` (2, 10).
        vector: of the plan frame.
        points: set to planned ZMP, DCM and CoM, measured DCM and CoM, and the corners of the
            support polygon, x, y (5 + n, 2) [m].
        feet: set to x, y, height [m], yaw [rad] of the references (2, 4).
        footsteps: x, y [m], yaw [rad] first, transformed in place (m, 4).

    Returns:
        the vector in the odometry frame.
    """
    x, y, vx, vy, zmp_x, zmp_y = pendulum
    ex, ey, evx, evy = error
    points[0, 0], points[0, 1] = zmp_x, zmp_y
    points[1, 0], points[1, 1] = x + vx / omega, y + vy / omega
    points[2, 0], points[2, 1] = x, y
    points[3, 0], points[3, 1] = x + ex + (vx + evx) / omega, y + ey + (vy + evy) / omega
    number = edges.shape[0]
    for k in range(number):
        corner = edges[(k + 1) % number]
        points[5 + k, 0], points[5 + k, 1] = corner[0], corner[1]
    for k in range(2):
        own = references[k]
        feet[k, 0], feet[k, 1], feet[k, 2], feet[k, 3] = own[0], own[1], own[3], own[2]
    frame = frame_of(planned, foot, odometry)
    transform(frame, points, -1)
    transform(frame, feet, 3)
    transform(frame, footsteps, 2)
    c, s = cos(odometry[2]), sin(odometry[2])
    points[4, 0] = odometry[0] + c * com[0] - s * com[1]
    points[4, 1] = odometry[1] + s * com[0] + c * com[1]
    _, _, c, s, _ = frame
    return c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]


@compiled
def incline(roll: float, pitch: float, rotation: Array) -> None:
    """Set the attitude R_RB (3, 3) of a trunk with roll and pitch [rad]."""
    cr, sr, cp, sp = cos(roll), sin(roll), cos(pitch), sin(pitch)
    rotation[0, 0], rotation[0, 1], rotation[0, 2] = cp, sp * sr, sp * cr
    rotation[1, 0], rotation[1, 1], rotation[1, 2] = 0.0, cr, -sr
    rotation[2, 0], rotation[2, 1], rotation[2, 2] = -sp, cp * sr, cp * cr


@compiled
def level_camera(
    tilt: Point, mounted: Array, place: Array, gyro: Array, rotation: Array, position: Array
) -> float:
    """Express the camera in the level frame of the trunk's heading.

    Args:
        tilt: roll and pitch of the trunk [rad].
        mounted: rotation R_BC of the camera in the base frame (3, 3).
        place: position p_BC of the camera in the base frame (3,) [m].
        gyro: angular velocity of the trunk in its frame (3,) [rad/s].
        rotation: set to R_RC (3, 3).
        position: set to p_RC (3,) [m].

    Returns:
        yaw rate of the trunk [rad/s].
    """
    R = np.empty((3, 3))
    incline(tilt[0], tilt[1], R)
    for i in range(3):
        for j in range(3):
            rotation[i, j] = (
                R[i, 0] * mounted[0, j] + R[i, 1] * mounted[1, j] + R[i, 2] * mounted[2, j]
            )
        position[i] = R[i, 0] * place[0] + R[i, 1] * place[1] + R[i, 2] * place[2]
    yaw_rate: float = R[2, 0] * gyro[0] + R[2, 1] * gyro[1] + R[2, 2] * gyro[2]
    return yaw_rate


@compiled
def frame_of(planned: Vector, foot: Vector, odometry: Vector) -> Frame:
    """Return the plan frame, given a foot in the plan and as measured.

    Args:
        planned: x, y [m], yaw [rad] of the foot in the plan frame.
        foot: measured x, y [m], yaw [rad] of the foot in the robot frame.
        odometry: x, y [m], heading [rad] of the robot frame.
    """
    x, y, heading = odometry
    c, s = cos(heading), sin(heading)
    yaw = heading + foot[2] - planned[2]
    cy, sy = cos(yaw), sin(yaw)
    return (
        x + c * foot[0] - s * foot[1] - cy * planned[0] + sy * planned[1],
        y + s * foot[0] + c * foot[1] - sy * planned[0] - cy * planned[1],
        cy,
        sy,
        yaw,
    )


@compiled
def transform(frame: Frame, rows: Array, yaw: int) -> None:
    """Transform points of the plan frame into the odometry frame.

    Args:
        frame: the plan frame.
        rows: x, y [m] first, transformed in place (n, m).
        yaw: column of a yaw angle to transform too [rad], -1 for none.
    """
    ox, oy, c, s, direction = frame
    for k in range(rows.shape[0]):
        x, y = rows[k, 0], rows[k, 1]
        rows[k, 0], rows[k, 1] = ox + c * x - s * y, oy + s * x + c * y
        if yaw >= 0:
            rows[k, yaw] += direction
