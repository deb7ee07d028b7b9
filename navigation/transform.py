"""Rigid transforms between the robot frame R and the field frame W."""

from collections.abc import Sequence
from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap

Array = NDArray[np.float64]


def sighting(pose: Sequence[float], landmark: tuple[float, float]) -> tuple[float, float]:
    """Range and bearing of a landmark.

    Args:
        pose: x, y, heading of R in W [m, m, rad].
        landmark: position in W [m].

    Returns:
        Range [m] and bearing in R, wrapped [rad].
    """
    dx = landmark[0] - pose[0]
    dy = landmark[1] - pose[1]
    return hypot(dx, dy), wrap(atan2(dy, dx) - pose[2])


def to_world(pose: Sequence[float], distance: float, bearing: float) -> tuple[float, float]:
    """Position in W of what is seen at `distance` [m] and `bearing` [rad] from `pose`."""
    direction = pose[2] + bearing
    return pose[0] + distance * cos(direction), pose[1] + distance * sin(direction)


def points_from(pose: Sequence[float], points: Array) -> Array:
    """Points in W (n, 2) as seen from `pose`: in R (n, 2) [m]."""
    x, y, heading = pose
    c, s = cos(heading), sin(heading)
    seen: Array = (points - (x, y)) @ np.array([[c, -s], [s, c]])
    return seen


def points_to_world(pose: Array, points: Array) -> Array:
    """Points in R (n, 2) of the robot at `pose` (3,): in W (n, 2) [m]."""
    c, s = cos(pose[2]), sin(pose[2])
    laid: Array = points @ np.array([[c, s], [-s, c]]) + pose[:2]
    return laid


def velocity_in_world(pose: Array, body: Array) -> Array:
    """Velocity over ground in W (2,) [m/s].

    Args:
        pose: x, y, heading of R in W (3,) [m, m, rad].
        body: forward, left, turn in R (3,) [m/s, m/s, rad/s].
    """
    forward, left, _ = body.tolist()
    c, s = cos(float(pose[2])), sin(float(pose[2]))
    return np.array([c * forward - s * left, s * forward + c * left])


def moved_on(pose: Array, before: Array, after: Array) -> tuple[Array, Array]:
    """A pose carried on by odometry.

    Args:
        pose: x, y, heading of R in W when the odometry was `before` (3,) [m, m, rad].
        before: pose of R in the odometry frame (3,) [m, m, rad].
        after: the same later (3,).

    Returns:
        Pose later, its heading not wrapped (3,) [m, m, rad], and its derivative by `pose` (3, 3).
    """
    dx, dy, turn = (after - before).tolist()
    x, y, heading = pose.tolist()
    offset = heading - float(before[2])
    c, s = cos(offset), sin(offset)
    right, up = c * dx - s * dy, s * dx + c * dy
    derivative = np.array([[1.0, 0.0, -up], [0.0, 1.0, right], [0.0, 0.0, 1.0]])
    return np.array([x + right, y + up, heading + turn]), derivative


def pose_from_points(seen: Array, known: Array) -> Array:
    """Pose that best lays seen points over known ones (least squares).

    Args:
        seen: points in R (n, 2), two or more [m].
        known: the same points in W (n, 2) [m].

    Returns:
        x, y, heading of R in W (3,) [m, m, rad].

    Raises:
        ValueError: if fewer than two points are given.
    """
    if len(seen) < 2:
        raise ValueError(f"a pose needs at least 2 landmarks, not {len(seen)}")
    seen_mean = seen.mean(axis=0)
    known_mean = known.mean(axis=0)
    a = seen - seen_mean
    b = known - known_mean
    turn = float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))
    heading = atan2(turn, float(np.sum(a * b)))
    c, s = cos(heading), sin(heading)
    x = float(known_mean[0] - c * seen_mean[0] + s * seen_mean[1])
    y = float(known_mean[1] - s * seen_mean[0] - c * seen_mean[1])
    return np.array([x, y, heading])
