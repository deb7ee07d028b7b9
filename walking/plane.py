"""Types of arrays and vectors, rotations and frames of the plane SE(2), and saturation."""

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Point = tuple[float, float]
Vector = tuple[float, float, float]

PlanePose = tuple[float, float, float]
"""x, y [m] of the origin and yaw [rad]."""


@compiled
def norm(x: float, y: float) -> float:
    """Return the length of a vector."""
    return sqrt(x * x + y * y)


@compiled
def rotate(yaw: float, x: float, y: float) -> Point:
    """Turn a vector by an angle [rad]."""
    c, s = cos(yaw), sin(yaw)
    return c * x - s * y, s * x + c * y


@compiled
def rotate_back(yaw: float, x: float, y: float) -> Point:
    """Express a vector in axes turned by an angle [rad]."""
    c, s = cos(yaw), sin(yaw)
    return c * x + s * y, c * y - s * x


@compiled
def from_frame(frame: PlanePose, x: float, y: float) -> Point:
    """Express a point of a frame in the parent frame [m]."""
    ox, oy, yaw = frame
    c, s = cos(yaw), sin(yaw)
    return ox + c * x - s * y, oy + s * x + c * y


@compiled
def within(value: float, lower: float, upper: float) -> float:
    """Clip a value to an interval."""
    return min(upper, max(lower, value))


@compiled
def clamp(value: float, limit: float) -> float:
    """Clip a value to ±`limit`."""
    return within(value, -limit, limit)


@compiled
def dead_zone(value: float, zone: float) -> float:
    """Return the excess of a value over a dead zone of ±`zone`, zero inside it."""
    if value > zone:
        return value - zone
    if value < -zone:
        return value + zone
    return 0.0
