"""Base pose of a body over its planted foot, and the readings of its IMU, compiled.

A pose is x, y, z and the quaternion w-x-y-z of the attitude (7,) [m].
"""

from math import asin, atan2, cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Ints = NDArray[np.intp]
Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]

PI = 3.141592653589793
GRAVITY = 9.81  # [m/s²]


@compiled
def _product(a: Quaternion, b: Quaternion) -> Quaternion:
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
def _rotate(q: Quaternion, v: Vector) -> Vector:
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


@compiled
def base_pose(
    positions: Array,
    attitudes: Array,
    feet: Ints,
    soles: Array,
    stance: int,
    anchor: Array,
    pose: Array,
    other: Array,
) -> tuple[float, float]:
    """Set the base pose with which the planted foot lies flat on the floor at its anchor.

    Args:
        positions: of all bodies in the base frame (n, 3) [m].
        attitudes: of all bodies in the base frame, quaternions (n, 4).
        feet: body indices of the left and the right foot (2,).
        soles: pose of the sole frame in each foot (2, 7).
        stance: planted foot, 0 or 1.
        anchor: x, y and yaw of the planted foot in W (3,) [m, m, rad].
        pose: set to the pose of the base in W (7,).
        other: set to x, y, yaw and height of the other sole in W (4,) [m, m, rad, m].

    Returns:
        tilt of the planted sole against the base, minus that of the other sole [rad]; height of
        the other sole above the planted one if the other one lay flat [m].
    """
    sole_positions = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    sole_attitudes = [(1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)]
    for side in range(2):
        body, sole = feet[side], soles[side]
        q = (attitudes[body, 0], attitudes[body, 1], attitudes[body, 2], attitudes[body, 3])
        x, y, z = _rotate(q, (sole[0], sole[1], sole[2]))
        origin = positions[body]
        sole_positions[side] = (origin[0] + x, origin[1] + y, origin[2] + z)
        sole_attitudes[side] = _product(q, (sole[3], sole[4], sole[5], sole[6]))
    w, x, y, z = sole_attitudes[stance]
    half = 0.5 * anchor[2]
    base = _product((cos(half), 0.0, 0.0, sin(half)), (w, -x, -y, -z))
    foot = _rotate(base, sole_positions[stance])
    pose[0], pose[1], pose[2] = anchor[0] - foot[0], anchor[1] - foot[1], -foot[2]
    pose[3], pose[4], pose[5], pose[6] = base
    offset = _rotate(base, sole_positions[1 - stance])
    x_axis = _rotate(_product(base, sole_attitudes[1 - stance]), (1.0, 0.0, 0.0))
    other[0], other[1] = pose[0] + offset[0], pose[1] + offset[1]
    other[2], other[3] = atan2(x_axis[1], x_axis[0]), pose[2] + offset[2]
    w, x, y, z = sole_attitudes[1 - stance]
    (ax, ay, az), (bx, by, bz) = sole_positions[stance], sole_positions[1 - stance]
    apart = _rotate((w, -x, -y, -z), (bx - ax, by - ay, bz - az))
    return _tilt(sole_attitudes[stance]) - _tilt(sole_attitudes[1 - stance]), apart[2]


@compiled
def _tilt(q: Quaternion) -> float:
    """Return the angle between the vertical axes of a frame and its parent [rad]."""
    return 2.0 * asin(min(1.0, sqrt(q[1] * q[1] + q[2] * q[2])))


@compiled
def imu_motion(
    before: Array, after: Array, period: float, velocity: Array, gyro: Array, force: Array
) -> None:
    """Set mean velocity and turn rate between two poses, and the specific force of a body at rest.

    Args:
        before: pose (7,).
        after: pose (7,), `period` later.
        period: time between them [s].
        velocity: set to the velocity of the origin in W (3,) [m/s].
        gyro: set to the angular velocity in the body's frame (3,) [rad/s].
        force: set to the specific force in the body's frame (3,) [m/s²].
    """
    for k in range(3):
        velocity[k] = (after[k] - before[k]) / period
    q = (after[3], after[4], after[5], after[6])
    w, x, y, z = _product((before[3], -before[4], -before[5], -before[6]), q)
    size = sqrt(x * x + y * y + z * z)
    angle = 2.0 * atan2(size, w)
    if angle > PI:  # shorter rotation
        angle -= 2.0 * PI
    rate = angle / (size * period) if size > 0.0 else 0.0
    gyro[0], gyro[1], gyro[2] = rate * x, rate * y, rate * z
    force[0], force[1], force[2] = _rotate((q[0], -q[1], -q[2], -q[3]), (0.0, 0.0, GRAVITY))
