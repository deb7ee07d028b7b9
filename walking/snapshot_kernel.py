"""Points and footholds of the plan seen from the odometry frame, compiled."""

from math import cos, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]
Vector = tuple[float, float, float]

Frame = tuple[float, float, float, float, float]
"""Origin x, y [m], cosine and sine of the direction, and the direction [rad] of the plan frame."""


@njit(cache=True)
def bring_over(
    planned: Vector,
    foot: Vector,
    odometry: Vector,
    points: Array,
    feet: Array,
    footsteps: Array,
    way: Point,
) -> Point:
    """Bring all that a snapshot shows of the plan over into the odometry frame.

    Args:
        planned: see `frame_of`.
        foot: see `frame_of`.
        odometry: see `frame_of`.
        points: x, y [m], brought over (n, 2).
        feet: x, y, height [m], yaw [rad], brought over (2, 4).
        footsteps: x, y [m], yaw [rad] first, brought over (m, 4).
        way: a direction of the plan frame.

    Returns:
        the direction in the odometry frame.
    """
    frame = frame_of(planned, foot, odometry)
    place(frame, points, -1)
    place(frame, feet, 3)
    place(frame, footsteps, 2)
    return turn(frame, way)


@njit(cache=True)
def frame_of(planned: Vector, foot: Vector, odometry: Vector) -> Frame:
    """Where the plan frame is if the planned foot stands where odometry sees it.

    Args:
        planned: x, y [m], yaw [rad] of the foot in the plan frame.
        foot: the same in the robot frame, as measured.
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


@njit(cache=True)
def place(frame: Frame, rows: Array, yaw: int) -> None:
    """Put points of the plan frame into the odometry frame.

    Args:
        frame: the plan frame.
        rows: x, y [m] first, brought over (n, m).
        yaw: column of a direction that is to be brought over too [rad], -1 for none.
    """
    ox, oy, c, s, direction = frame
    for k in range(rows.shape[0]):
        x, y = rows[k, 0], rows[k, 1]
        rows[k, 0], rows[k, 1] = ox + c * x - s * y, oy + s * x + c * y
        if yaw >= 0:
            rows[k, yaw] += direction


@njit(cache=True)
def turn(frame: Frame, vector: Point) -> Point:
    """A direction of the plan frame in the odometry frame."""
    _, _, c, s, _ = frame
    x, y = vector
    return c * x - s * y, s * x + c * y
