"""Rigid transforms of the plane, SE(2), between the robot frame R and the field frame W."""

from collections.abc import Sequence
from math import atan2, cos, sin
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Coordinate = TypeVar("Coordinate", float, Array)


class SE2(NamedTuple):
    """Rigid transform of the plane: `pose @ point` rotates by `heading`, then translates.

    Attributes:
        x, y: translation [m].
        heading: counter-clockwise [rad].
    """

    x: float
    y: float
    heading: float

    def __matmul__(self, point: tuple[Coordinate, Coordinate]) -> tuple[Coordinate, Coordinate]:
        """Transform a point, or the coordinates (n,) of points [m]."""
        u, v = rotate(self.heading, point)
        return self.x + u, self.y + v


def rotate(angle: float, vector: tuple[Coordinate, Coordinate]) -> tuple[Coordinate, Coordinate]:
    """Rotate a vector, or the coordinates (n,) of vectors, by `angle` [rad]."""
    c, s = cos(angle), sin(angle)
    u, v = vector
    return c * u - s * v, s * u + c * v


def yaw_rotation(angle: float) -> Array:
    """Return the rotation matrix about the vertical axis (3, 3); `angle` [rad]."""
    c, s = cos(angle), sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def to_world(pose: Sequence[float], distance: float, bearing: float) -> tuple[float, float]:
    """Return the position in W of a point at `distance` [m] and `bearing` [rad] from `pose`."""
    direction = pose[2] + bearing
    return pose[0] + distance * cos(direction), pose[1] + distance * sin(direction)


@compiled
def in_robot(pose: Array, x: float, y: float) -> tuple[float, float]:
    """Transform a point from W to R of the robot at `pose` (3,) [m]."""
    dx, dy, c, s = x - pose[0], y - pose[1], cos(pose[2]), sin(pose[2])
    return c * dx + s * dy, c * dy - s * dx


def points_to_robot(pose: Sequence[float] | Array, points: Array) -> Array:
    """Transform points (n, 2) from W to R of the robot at `pose` [m]."""
    x, y, heading = pose
    c, s = cos(heading), sin(heading)
    in_robot: Array = (points - (x, y)) @ np.array([[c, -s], [s, c]])
    return in_robot


def points_to_world(pose: Sequence[float] | Array, points: Array) -> Array:
    """Transform points (n, 2) from R of the robot at `pose` to W [m]."""
    c, s = cos(pose[2]), sin(pose[2])
    in_world: Array = points @ np.array([[c, s], [-s, c]]) + pose[:2]
    return in_world


def velocity_in_world(pose: Array, twist: Array) -> Array:
    """Return the velocity over ground in W (2,) [m/s].

    Args:
        pose: x, y, heading of R in W (3,) [m, m, rad].
        twist: vx, vy, wz in R (3,) [m/s, m/s, rad/s].
    """
    vx, vy, _ = twist.tolist()
    return np.array(rotate(float(pose[2]), (vx, vy)))


def propagate(pose: Array, before: Array, after: Array) -> tuple[Array, Array]:
    """Propagate a pose by odometry.

    Args:
        pose: x, y, heading of R in W when the odometry was `before` (3,) [m, m, rad].
        before: pose of R in the odometry frame (3,) [m, m, rad].
        after: the later pose of R in the odometry frame (3,) [m, m, rad].

    Returns:
        The later pose, its heading not wrapped (3,) [m, m, rad], and its Jacobian with respect
        to `pose` (3, 3).
    """
    dx, dy, turn = (after - before).tolist()
    x, y, heading = pose.tolist()
    u, v = rotate(heading - float(before[2]), (dx, dy))
    jacobian = np.array([[1.0, 0.0, -v], [0.0, 1.0, u], [0.0, 0.0, 1.0]])
    return np.array([x + u, y + v, heading + turn]), jacobian


def pose_from_points(observed: Array, known: Array) -> Array:
    """Return the pose that aligns observed with known points (least squares).

    Args:
        observed: points in R (n, 2), n >= 2 [m].
        known: the same points in W (n, 2) [m].

    Returns:
        x, y, heading of R in W (3,) [m, m, rad].
    """
    observed_mean = observed.mean(axis=0)
    known_mean = known.mean(axis=0)
    a = observed - observed_mean
    b = known - known_mean
    cross = float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))
    heading = atan2(cross, float(np.sum(a * b)))
    c, s = cos(heading), sin(heading)
    x = float(known_mean[0] - c * observed_mean[0] + s * observed_mean[1])
    y = float(known_mean[1] - s * observed_mean[0] - c * observed_mean[1])
    return np.array([x, y, heading])
