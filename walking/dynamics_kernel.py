"""Dynamics of the robot on its base, and the set-points that make up for them, compiled.

The robot is a table, a row for the base and one for every joint with the body that it moves,
parents before children:

    row of the parent | joint in the parent's frame x, y, z [m] | its axis | mass [kg] |
    mass centre in the frame of the joint x, y, z [m] | inertia about that xx, xy, yy, xz, yz, zz
    [kg m²] | inertia of the joint's motor [kg m²] (27, 18).

All frames are parallel while all angles are zero. Of the base's row only mass, mass centre and
inertia count.
"""

from math import cos, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]
Vector = tuple[float, float, float]
Leg = tuple[float, float, float, float, float, float]
"""Numbers of `LegDimensions` in their order [m]."""

Angles = tuple[float, float, float, float, float, float]
"""Hip yaw, roll, pitch, knee, ankle pitch, roll [rad]."""

Balance = tuple[Point, Point, Vector]
"""Directions of the left and of the right foot [rad]; by how much the ankles are to move the ZMP,
in the plan frame [m]; angular velocity of the trunk [rad/s]."""

Ankles = tuple[float, float, float, float]
"""Weight of the robot [N]; stiffness of pitch and of roll [N m/rad]; damping by the gyro [s]."""

BODY = 18  # numbers of a body
PLACE, MOTION = 15, 15  # numbers of where a body is, and of how it moves


@njit(cache=True)
def com(bodies: Array, angles: Array) -> Vector:
    """Centre of mass in the base frame for joint angles (26,) [m]."""
    return _com(bodies, _places(bodies, angles))


@njit(cache=True)
def forces(
    bodies: Array, angles: Array, rates: Array, changes: Array, base: Vector, torques: Array
) -> tuple[Vector, Vector, Vector]:
    """What a motion of the joints asks of joints and base, nothing touching the feet.

    Newton's and Euler's equations of every body, in the frame of the base (Luh, Walker & Paul,
    J. Dyn. Syst. Meas. Control 102, 1980).

    Args:
        bodies: the robot.
        angles: of the joints (26,) [rad].
        rates: of these (26,) [rad/s].
        changes: of those (26,) [rad/s²].
        base: acceleration of the base, gravity taken off [m/s²]; it does not turn.
        torques: of the joints, set (26,) [N m].

    Returns:
        force [N] and moment [N m] at the base, in its frame and about its origin; centre of mass
        [m].
    """
    count = bodies.shape[0]
    places = _places(bodies, angles)
    # Angular velocity and acceleration, acceleration of the origin, force, moment about the origin.
    motions = np.zeros((count, MOTION))
    motions[0, 6], motions[0, 7], motions[0, 8] = base
    for k in range(count):
        body, place, motion = bodies[k], places[k], motions[k]
        if k > 0:
            before, p = motions[int(body[0])], places[int(body[0])]
            w, turn = _vector(before, 0), _vector(before, 3)
            axis, rate = _vector(place, 12), rates[k - 1]
            spin = (rate * axis[0], rate * axis[1], rate * axis[2])
            coupled = _cross(w, spin)
            arm = (place[9] - p[9], place[10] - p[10], place[11] - p[11])
            carried = _acceleration(w, turn, arm)
            for i in range(3):
                motion[i] = w[i] + spin[i]
                motion[3 + i] = turn[i] + changes[k - 1] * axis[i] + coupled[i]
                motion[6 + i] = before[6 + i] + carried[i]
        w, turn = _vector(motion, 0), _vector(motion, 3)
        lever = _turned(place, _vector(body, 8))
        own = _acceleration(w, turn, lever)
        mass = body[7]
        force = (
            mass * (motion[6] + own[0]),
            mass * (motion[7] + own[1]),
            mass * (motion[8] + own[2]),
        )
        # The inertia is known in the frame of the body.
        moment = _turned(place, _inertia(body, _back(place, turn)))
        gyration = _cross(w, _turned(place, _inertia(body, _back(place, w))))
        levered = _cross(lever, force)
        for i in range(3):
            motion[9 + i] = force[i]
            motion[12 + i] = moment[i] + gyration[i] + levered[i]
    for k in range(count - 1, 0, -1):
        place, motion = places[k], motions[k]
        before, p = motions[int(bodies[k, 0])], places[int(bodies[k, 0])]
        torques[k - 1] = bodies[k, 17] * changes[k - 1]
        for i in range(3):
            torques[k - 1] += place[12 + i] * motion[12 + i]
        arm = (place[9] - p[9], place[10] - p[10], place[11] - p[11])
        levered = _cross(arm, _vector(motion, 9))
        for i in range(3):
            before[9 + i] += motion[9 + i]
            before[12 + i] += motion[12 + i] + levered[i]
    return _vector(motions[0], 9), _vector(motions[0], 12), _com(bodies, places)


@njit(cache=True)
def offsets(
    bodies: Array,
    position: Array,
    before: Array,
    velocity: Array,
    pelvis: Vector,
    base: Vector,
    law: Vector,
    servos: tuple[Array, Array],
    spots: tuple[Point, Point],
    right_load: float,
    legs: tuple[Leg, Leg],
    height: float,
    balance: Balance,
    ankles: Ankles,
) -> tuple[Array, Vector]:
    """Set-point offsets that make up for load and lag of the servos.

    Args:
        bodies: the robot.
        position: joint angles (26,) [rad].
        before: those of the last tick, to be those of this one (26,) [rad].
        velocity: their rates, of the last tick, then of this one (26,) [rad/s].
        pelvis: x, y [m], heading [rad] in the plan frame.
        base: acceleration of the base in the plan frame, gravity taken off [m/s²].
        law: share of the joints' acceleration that counts [1], its limit [rad/s²], period of
            control [s].
        servos: compliance [rad/(N m)] and velocity lag [s] (26,).
        spots: where the ZMP is meant to be under either foot, in the plan frame [m].
        right_load: share of the weight on the right foot [1].
        legs: left and right.
        height: of the base above the floor [m].
        balance: what the ankles are to do besides.
        ankles: their numbers.

    Returns:
        the offsets (26,) [rad], and the centre of mass in the base frame [m].
    """
    acceleration, found = np.empty(position.size), np.empty(position.size)
    follow(position, before, velocity, acceleration, law)
    c, s = cos(pelvis[2]), sin(pelvis[2])
    ahead, aside = c * base[0] + s * base[1], c * base[1] - s * base[0]
    (fx, fy, fz), (nx, ny, _), centre = forces(
        bodies, position, velocity, acceleration, (ahead, aside, base[2]), found
    )
    lx, ly = _in_base(pelvis, spots[0])
    rx, ry = _in_base(pelvis, spots[1])
    left_load = 1.0 - right_load
    # The ZMP of the whole body, from where the feet alone would have it.
    dx = -(ny + height * fx) / fz - left_load * lx - right_load * rx
    dy = (nx - height * fy) / fz - left_load * ly - right_load * ry
    for index in range(2):
        load = right_load if index else left_load
        if load > 0.0:
            own = position[6 * index : 6 * index + 6]
            angles = (own[0], own[1], own[2], own[3], own[4], own[5])
            x, y = (rx, ry) if index else (lx, ly)
            point = (x + dx, y + dy, -height)
            force = (load * fx, load * fy, load * fz)
            added = support_torques(legs[index], angles, point, force)
            for joint in range(6):
                found[6 * index + joint] += added[joint]
    compliance, lag = servos
    for joint in range(position.size):
        found[joint] = found[joint] * compliance[joint] + velocity[joint] * lag[joint]
    for index in range(2):
        load = right_load if index else left_load
        if load > 0.0:
            pitch, roll = ankle(balance, index, load, ankles)
            found[6 * index + 4] += pitch
            found[6 * index + 5] += roll
    return found, centre


@njit(cache=True)
def follow(
    position: Array, before: Array, velocity: Array, acceleration: Array, law: Vector
) -> None:
    """Bring rates of the joints up to date.

    Args:
        position: joint angles (26,) [rad].
        before: those of the last tick, to be those of this one (26,) [rad].
        velocity: their rates, of the last tick, then of this one (26,) [rad/s].
        acceleration: set to a share of the change of those rates, cut off at a limit [rad/s²].
        law: that share [1] and limit [rad/s²], period of control [s].
    """
    gain, limit, period = law
    for joint in range(position.size):
        now = (position[joint] - before[joint]) / period
        change = gain * (now - velocity[joint]) / period
        acceleration[joint] = min(limit, max(-limit, change))
        velocity[joint] = now
        before[joint] = position[joint]


@njit(cache=True)
def support_torques(leg: Leg, angles: Angles, point: Vector, force: Vector) -> Angles:
    """Torques [N m] by which a massless leg hands a force of the floor on to the base.

    Args:
        leg: dimensions.
        angles: of its joints.
        point: where the floor pushes, in the base frame [m].
        force: of the floor on the foot, in the base frame [N].
    """
    hip_x, hip_y, hip_z, l1, l2, _ = leg
    a, b, c, d, e, _ = angles
    ca, sa, cb, sb = cos(a), sin(a), cos(b), sin(b)
    sg, cg = sin(c + d + e), cos(c + d + e)
    fx, fy, fz = force
    # Arms of the force about hip, knee and ankle.
    hx, hy, hz = point[0] - hip_x, point[1] - hip_y, point[2] - hip_z
    along, down = -l1 * sin(c), -l1 * cos(c)
    kx, ky, kz = hx - ca * along - sa * sb * down, hy - sa * along + ca * sb * down, hz - cb * down
    along, down = along - l2 * sin(c + d), down - l2 * cos(c + d)
    ax, ay, az = hx - ca * along - sa * sb * down, hy - sa * along + ca * sb * down, hz - cb * down
    # Common pitch axis, and the axis of the ankle roll.
    px, py, pz = -sa * cb, ca * cb, sb
    rx, ry, rz = ca * cg - sa * sg * sb, sa * cg + ca * sg * sb, -sg * cb
    mx, my, mz = hy * fz - hz * fy, hz * fx - hx * fz, hx * fy - hy * fx
    nx, ny, nz = ay * fz - az * fy, az * fx - ax * fz, ax * fy - ay * fx
    return (
        -mz,
        -ca * mx - sa * my,
        -px * mx - py * my - pz * mz,
        -px * (ky * fz - kz * fy) - py * (kz * fx - kx * fz) - pz * (kx * fy - ky * fx),
        -px * nx - py * ny - pz * nz,
        -rx * nx - ry * ny - rz * nz,
    )


@njit(cache=True)
def ankle(balance: Balance, index: int, load: float, ankles: Ankles) -> Point:
    """Set-points of pitch and roll that move the ZMP of a foot carrying a share `load` [rad]."""
    yaw, (dx, dy), gyro = balance[0][index], balance[1], balance[2]
    c, s = cos(yaw), sin(yaw)
    x, y = c * dx + s * dy, c * dy - s * dx
    weight, damping = ankles[0] * load, ankles[3] * load
    return weight / ankles[1] * x + damping * gyro[1], -weight / ankles[2] * y + damping * gyro[0]


@njit(cache=True)
def _in_base(pelvis: Vector, point: Point) -> Point:
    """A point of the plan frame in the frame of the base [m]."""
    c, s = cos(pelvis[2]), sin(pelvis[2])
    x, y = point[0] - pelvis[0], point[1] - pelvis[1]
    return c * x + s * y, c * y - s * x


@njit(cache=True)
def _places(bodies: Array, angles: Array) -> Array:
    """Of every body in the base frame: rotation, row by row | origin [m] | axis (27, 15)."""
    count = bodies.shape[0]
    places = np.zeros((count, PLACE))
    places[0, 0] = places[0, 4] = places[0, 8] = 1.0
    for k in range(1, count):
        body, place = bodies[k], places[k]
        parent = places[int(body[0])]
        arm, axis = _turned(parent, _vector(body, 1)), _vector(body, 4)
        along = _turned(parent, axis)
        for i in range(3):
            place[9 + i], place[12 + i] = parent[9 + i] + arm[i], along[i]
        x, y, z = axis
        c, s = cos(angles[k - 1]), sin(angles[k - 1])
        d = 1.0 - c
        one = (c + d * x * x, d * x * y + s * z, d * x * z - s * y)
        two = (d * x * y - s * z, c + d * y * y, d * y * z + s * x)
        three = (d * x * z + s * y, d * y * z - s * x, c + d * z * z)
        one, two, three = _turned(parent, one), _turned(parent, two), _turned(parent, three)
        for i in range(3):
            place[3 * i], place[3 * i + 1], place[3 * i + 2] = one[i], two[i], three[i]
    return places


@njit(cache=True)
def _com(bodies: Array, places: Array) -> Vector:
    mass = x = y = z = 0.0
    for k in range(bodies.shape[0]):
        own, place = bodies[k, 7], places[k]
        lever = _turned(place, _vector(bodies[k], 8))
        mass += own
        x += own * (place[9] + lever[0])
        y += own * (place[10] + lever[1])
        z += own * (place[11] + lever[2])
    return x / mass, y / mass, z / mass


@njit(cache=True)
def _acceleration(w: Vector, turn: Vector, arm: Vector) -> Vector:
    """Of a point on a body against the origin from which its arm is [m/s²]."""
    outward = _cross(w, _cross(w, arm))
    along = _cross(turn, arm)
    return along[0] + outward[0], along[1] + outward[1], along[2] + outward[2]


@njit(cache=True)
def _inertia(body: Array, v: Vector) -> Vector:
    xx, xy, yy, xz, yz, zz = body[11], body[12], body[13], body[14], body[15], body[16]
    return (
        xx * v[0] + xy * v[1] + xz * v[2],
        xy * v[0] + yy * v[1] + yz * v[2],
        xz * v[0] + yz * v[1] + zz * v[2],
    )


@njit(cache=True)
def _turned(place: Array, v: Vector) -> Vector:
    """A vector of a body in the base frame."""
    return (
        place[0] * v[0] + place[1] * v[1] + place[2] * v[2],
        place[3] * v[0] + place[4] * v[1] + place[5] * v[2],
        place[6] * v[0] + place[7] * v[1] + place[8] * v[2],
    )


@njit(cache=True)
def _back(place: Array, v: Vector) -> Vector:
    """A vector of the base frame in that of a body."""
    return (
        place[0] * v[0] + place[3] * v[1] + place[6] * v[2],
        place[1] * v[0] + place[4] * v[1] + place[7] * v[2],
        place[2] * v[0] + place[5] * v[1] + place[8] * v[2],
    )


@njit(cache=True)
def _vector(row: Array, first: int) -> Vector:
    return row[first], row[first + 1], row[first + 2]


@njit(cache=True)
def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
