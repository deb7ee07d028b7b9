"""The few rotations the world needs; quaternions are w-x-y-z as in MuJoCo."""

from math import atan2, cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]


def quaternion_from_yaw(yaw: float) -> Array:
    """Rotation by `yaw` [rad] about z."""
    return np.array([cos(0.5 * yaw), 0.0, 0.0, sin(0.5 * yaw)])


@compiled
def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the Hamilton product: first `b`, then `a`."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


@compiled
def rotate(q: Quaternion, v: Vector) -> Vector:
    """Rotate a vector by a unit quaternion."""
    w, x, y, z = q
    # Twice the cross product of the quaternion's axis with the vector.
    a = 2.0 * (y * v[2] - z * v[1])
    b = 2.0 * (z * v[0] - x * v[2])
    c = 2.0 * (x * v[1] - y * v[0])
    return (
        v[0] + w * a + y * c - z * b,
        v[1] + w * b + z * a - x * c,
        v[2] + w * c + x * b - y * a,
    )


def quaternion_product(a: Array, b: Array) -> Array:
    """Hamilton product: first `b`, then `a`."""
    return np.array(product(tuple(a.tolist()), tuple(b.tolist())))


def small_rotation(roll: float, pitch: float) -> Array:
    """Quaternion of a small rotation about x and y [rad]."""
    norm = sqrt(1.0 + 0.25 * (roll * roll + pitch * pitch))
    return np.array([1.0 / norm, 0.5 * roll / norm, 0.5 * pitch / norm, 0.0])


def heading(quaternion: Array) -> float:
    """Yaw of the x axis of a body [rad]."""
    w, x, y, z = quaternion.tolist()
    return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def up_component(quaternion: Array) -> float:
    """Cosine of the angle between the body's z axis and the vertical."""
    _, x, y, _ = quaternion.tolist()
    return float(1.0 - 2.0 * (x * x + y * y))
