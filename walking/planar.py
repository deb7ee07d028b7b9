"""Rotations and frames of the plane, SE(2)."""

from math import cos, sin, sqrt

from compilation import compiled
from walking.arrays import Point

Frame = tuple[float, float, float]
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
def from_frame(frame: Frame, x: float, y: float) -> Point:
    """Express a point of a frame in the parent frame [m]."""
    ox, oy, yaw = frame
    c, s = cos(yaw), sin(yaw)
    return ox + c * x - s * y, oy + s * x + c * y
