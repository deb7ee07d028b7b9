"""Where a body stands whose one foot is planted, and what it feels there, compiled.

A pose is x, y, z and the quaternion w-x-y-z of the attitude (7,) [m].
"""

from math import atan2, cos, sin, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.intp]
Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]

PI = 3.141592653589793
GRAVITY = 9.81  # [m/s²]


@njit(cache=True)
def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Hamilton product: first `b`, then `a`."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


@njit(cache=True)
def _turned(q: Quaternion, v: Vector) -> Vector:
    """A vector turned by a unit quaternion."""
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


@njit(cache=True)
def stand(
    places: Array,
    attitudes: Array,
    feet: Ints,
    soles: Array,
    stance: int,
    anchor: Array,
    pose: Array,
    other: Array,
) -> None:
    """Place a body so that one of its feet lies flat on the floor where it is planted.

    Args:
        places: of all bodies, seen from the base (n, 3) [m].
        attitudes: of all bodies in it, quaternions (n, 4).
        feet: which of them are the left and the right foot (2,).
        soles: the sole's frame in each foot, place and quaternion (2, 7) [m].
        stance: which foot is planted, 0 or 1.
        anchor: where: x, y and yaw in W (3,) [m, m, rad].
        pose: set to that of the base in W (7,).
        other: set to x, y, yaw and height of the other sole in W (4,) [m, m, rad, m].
    """
    found = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    turns = [(1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)]
    for side in range(2):
        body, sole = feet[side], soles[side]
        q = (attitudes[body, 0], attitudes[body, 1], attitudes[body, 2], attitudes[body, 3])
        x, y, z = _turned(q, (sole[0], sole[1], sole[2]))
        found[side] = (places[body, 0] + x, places[body, 1] + y, places[body, 2] + z)
        turns[side] = _product(q, (sole[3], sole[4], sole[5], sole[6]))
    w, x, y, z = turns[stance]
    half = 0.5 * anchor[2]
    base = _product((cos(half), 0.0, 0.0, sin(half)), (w, -x, -y, -z))
    foot = _turned(base, found[stance])
    pose[0], pose[1], pose[2] = anchor[0] - foot[0], anchor[1] - foot[1], -foot[2]
    pose[3], pose[4], pose[5], pose[6] = base
    away = _turned(base, found[1 - stance])
    ahead = _turned(_product(base, turns[1 - stance]), (1.0, 0.0, 0.0))
    other[0], other[1] = pose[0] + away[0], pose[1] + away[1]
    other[2], other[3] = atan2(ahead[1], ahead[0]), pose[2] + away[2]


@njit(cache=True)
def felt(
    before: Array, after: Array, period: float, velocity: Array, turning: Array, force: Array
) -> None:
    """Mean velocity from one pose to the next, and what a resting body feels of gravity.

    Args:
        before: pose (7,).
        after: pose (7,), `period` later.
        period: time between them [s].
        velocity: set to that of the origin in W (3,) [m/s].
        turning: set to the angular velocity in the body's frame (3,) [rad/s].
        force: set to the specific force in the body's frame (3,) [m/s²].
    """
    for k in range(3):
        velocity[k] = (after[k] - before[k]) / period
    q = (after[3], after[4], after[5], after[6])
    w, x, y, z = _product((before[3], -before[4], -before[5], -before[6]), q)
    size = sqrt(x * x + y * y + z * z)
    angle = 2.0 * atan2(size, w)
    if angle > PI:  # the shorter way round
        angle -= 2.0 * PI
    share = angle / (size * period) if size > 0.0 else 0.0
    turning[0], turning[1], turning[2] = share * x, share * y, share * z
    force[0], force[1], force[2] = _turned((q[0], -q[1], -q[2], -q[3]), (0.0, 0.0, GRAVITY))
