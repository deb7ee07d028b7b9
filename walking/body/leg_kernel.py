"""Leg kinematics, whole-body posture and servo feed-forward of a control tick, compiled.

Constant numbers are rows of arrays: tuples are unpacked at every call.
"""

from math import acos, asin, atan2, cos, hypot, sin

from numba import njit

from walking.arrays import Array, Indices, Point, Vector

Leg = tuple[float, float, float, float, float, float]
"""Fields of `LegDimensions` in order [m]."""

Pose = tuple[float, float, float, float, float, float]
"""Pose of a foot in the base frame: x, y, z [m], roll, pitch, yaw [rad]."""

Angles = tuple[float, float, float, float, float, float]
"""Hip yaw, roll, pitch, knee, ankle pitch, roll [rad]."""

AnkleTask = tuple[Point, Point, Array]
"""Task of the ankles: yaw of the left and right foot [rad]; shift of the ZMP in the plan frame [m];
angular velocity of the trunk to damp (3,) [rad/s]."""

MIN_TILT = 1e-6  # smaller tilts of a foot are set to zero [rad]


@njit(cache=True)
def leg_angles(leg: Leg, foot: Pose) -> tuple[Angles, bool]:
    """Return the joint angles for a foot pose, and whether it is in reach (inverse kinematics).

    The three hip axes meet in one point and so do the two ankle axes, hence the closed form: the
    direction from ankle to hip in the foot frame gives the ankle roll, the distance gives the
    knee, an Euler decomposition gives the hip.
    """
    hip_x, hip_y, hip_z, l1, l2, h = leg
    x, y, z, roll, pitch, yaw = foot
    cr, sr = cos(roll), sin(roll)
    cp, sp = cos(pitch), sin(pitch)
    cy, sy = cos(yaw), sin(yaw)
    # Columns of R_BF.
    xx, xy, xz = cy * cp, sy * cp, -sp
    yx, yy, yz = cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr
    zx, zy, zz = cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr
    dx = hip_x - x - h * zx
    dy = hip_y - y - h * zy
    dz = hip_z - z - h * zz
    # Ankle to hip in the foot frame.
    rx = xx * dx + xy * dy + xz * dz
    ry = yx * dx + yy * dy + yz * dz
    rz = zx * dx + zy * dy + zz * dz
    cosine = (rx * rx + ry * ry + rz * rz - l1 * l1 - l2 * l2) / (2.0 * l1 * l2)
    reachable = -1.0 <= cosine <= 1.0
    knee = acos(min(1.0, max(-1.0, cosine)))
    ankle_roll = atan2(ry, rz)
    ankle_pitch = atan2(-l1 * sin(knee), l2 + l1 * cos(knee)) - atan2(rx, hypot(ry, rz))
    # R_BF Rx(-ankle_roll) Ry(-knee - ankle_pitch) = Rz(yaw) Rx(roll) Ry(pitch) of the hip.
    cf, sf = cos(ankle_roll), sin(ankle_roll)
    cg, sg = cos(knee + ankle_pitch), sin(knee + ankle_pitch)
    mx, my, mz = cf * yx - sf * zx, cf * yy - sf * zy, cf * yz - sf * zz
    nz = sf * yz + cf * zz
    hip_roll = asin(min(1.0, max(-1.0, mz)))
    hip_yaw = atan2(-mx, my)
    hip_pitch = atan2(-(cg * xz + sg * nz), cg * nz - sg * xz)
    return (hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll), reachable


@njit(cache=True)
def support_torques(leg: Leg, angles: Angles, point: Vector, force: Vector) -> Angles:
    """Return the joint torques [N m] of a massless leg that transmits a contact force to the base.

    Args:
        leg: dimensions.
        angles: of its joints.
        point: of contact, in the base frame [m].
        force: of the floor on the foot, in the base frame [N].
    """
    hip_x, hip_y, hip_z, l1, l2, _ = leg
    a, b, c, d, e, _ = angles
    ca, sa, cb, sb = cos(a), sin(a), cos(b), sin(b)
    sg, cg = sin(c + d + e), cos(c + d + e)
    fx, fy, fz = force
    # Lever arms of the force about hip, knee and ankle.
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
def pose(
    position: Array,
    tilts: Array,
    feet: Array,
    which: tuple[int, int],
    com: Point,
    head: Point,
    tilt: Point,
    tilt_control: Array,
    build: Array,
    legs: Array,
) -> Vector:
    """Set the joints of legs, head and arms.

    A foot in the air is kept parallel to the floor against the tilt of the trunk.

    Args:
        position: joint angles of the ready posture, set to those of this tick (26,) [rad].
        tilts: roll and pitch of each foot against the tilt of the trunk, updated (2, 2) [rad].
        feet: foot references, see `walking.gait.swing_foot_kernel` (2, 10).
        which: index of the support foot, and of the foot in the air, -1 for none.
        com: planned centre of mass, x, y in the plan frame [m].
        head: pan and tilt [rad].
        tilt: measured roll and pitch of the trunk [rad].
        tilt_control: gain from tilt to foot [1], dead zone [rad], filter gain and decay per tick
            [1], height of the base above the floor [m] (5,).
        build: centre of mass ahead of the base [m]; shoulder pitch per distance between the feet
            [rad/m] and its limit [rad] (3,).
        legs: left and right, see `Leg` (2, 6).

    Returns:
        the pelvis: x, y [m], heading [rad] in the plan frame.
    """
    pelvis = pelvis_of(feet, com, build[0])
    apart = _pose_legs(position, tilts, feet, which, pelvis, tilt, tilt_control, legs)
    # Counter-swing, backward positive on the side of the foot ahead.
    swing = min(build[2], max(-build[2], build[1] * apart))
    position[12], position[13] = head
    position[14] += swing
    position[20] -= swing
    return pelvis


@njit(cache=True)
def pelvis_of(feet: Array, com: Point, ahead: float) -> Vector:
    """Return the pelvis for a centre of mass `com` ahead of it; its heading is between the feet."""
    yaw = 0.5 * (feet[0][2] + feet[1][2])
    return com[0] - ahead * cos(yaw), com[1] - ahead * sin(yaw), yaw


@njit(cache=True)
def _pose_legs(
    position: Array,
    tilts: Array,
    feet: Array,
    which: tuple[int, int],
    pelvis: Vector,
    tilt: Point,
    tilt_control: Array,
    legs: Array,
) -> float:
    """Set the joints of the legs; return the distance of the left foot ahead of the right [m]."""
    c, s = cos(pelvis[2]), sin(pelvis[2])
    gain, zone, pull, decay = tilt_control[0], tilt_control[1], tilt_control[2], tilt_control[3]
    base = tilt_control[4]
    support = feet[which[0]]
    for index in range(2):
        own = tilts[index]
        for axis in range(2):
            if index == which[1]:
                excess = max(0.0, tilt[axis] - zone) + min(0.0, tilt[axis] + zone)
                own[axis] += pull * (gain * excess - own[axis])
            elif own[axis] != 0.0:
                own[axis] *= decay
                if abs(own[axis]) < MIN_TILT:
                    own[axis] = 0.0
        foot = feet[index]
        x, y, yaw, height = foot[0], foot[1], foot[2], foot[3]
        roll, pitch = own[0], own[1]
        if roll != 0.0 or pitch != 0.0:
            ax, ay = x - support[0], y - support[1]
            height += pitch * (c * ax + s * ay) - roll * (c * ay - s * ax)
        dx, dy, turned = x - pelvis[0], y - pelvis[1], yaw - pelvis[2]
        cf, sf = cos(turned), sin(turned)
        target = (
            c * dx + s * dy,
            c * dy - s * dx,
            height - base,
            -(cf * roll + sf * pitch),
            -(cf * pitch - sf * roll),
            turned,
        )
        angles, _ = leg_angles(_leg(legs, index), target)
        for joint in range(6):
            position[6 * index + joint] = angles[joint]
    apart: float = c * (feet[0][0] - feet[1][0]) + s * (feet[0][1] - feet[1][1])
    return apart


@njit(cache=True)
def rates(
    position: Array,
    before: Array,
    velocity: Array,
    q: Array,
    v: Array,
    a: Array,
    in_q: Indices,
    in_v: Indices,
    pelvis: Vector,
    base: Point,
    inertia: Array,
) -> None:
    """Differentiate the joint angles and set the motion of the dynamic model.

    Args:
        position: joint angles (26,) [rad].
        before: those of the last tick, updated (26,) [rad].
        velocity: joint rates, updated (26,) [rad/s].
        q: position of the model, set.
        v: velocity of the model, set.
        a: acceleration of the model, set.
        in_q: indices of the joints in q (26,).
        in_v: indices of the joints in v and a (26,).
        pelvis: x, y [m], heading [rad] in the plan frame.
        base: acceleration of the base in the plan frame [m/s²].
        inertia: gain [1] and limit [rad/s²] of the joint accelerations, period of control [s] (3,).
    """
    gain, limit, period = inertia[0], inertia[1], inertia[2]
    c, s = cos(pelvis[2]), sin(pelvis[2])
    a[0], a[1] = c * base[0] + s * base[1], c * base[1] - s * base[0]
    for joint in range(position.size):
        now = (position[joint] - before[joint]) / period
        change = gain * (now - velocity[joint]) / period
        velocity[joint] = now
        before[joint] = position[joint]
        q[in_q[joint]] = position[joint]
        v[in_v[joint]] = now
        a[in_v[joint]] = min(limit, max(-limit, change))


@njit(cache=True)
def offsets(
    forces: Array,
    in_v: Indices,
    position: Array,
    velocity: Array,
    servos: Array,
    pelvis: Vector,
    foot_zmps: tuple[Point, Point],
    right_load: float,
    base: float,
    legs: Array,
    task: AnkleTask,
    ankles: Array,
    offset: Array,
) -> None:
    """Set the feed-forward offsets against load and lag of the servos.

    Args:
        forces: generalised forces of the motion without contact, force [N] and moment [N m] at the
            base first.
        in_v: indices of the joints in these (26,).
        position: joint angles (26,) [rad].
        velocity: joint rates (26,) [rad/s].
        servos: compliance [rad/(N m)] and velocity lag [s] (2, 26).
        pelvis: x, y [m], heading [rad] in the plan frame.
        foot_zmps: planned ZMP under each foot, in the plan frame [m].
        right_load: load fraction of the right foot [1].
        base: height of the base above the floor [m].
        legs: left and right, see `Leg` (2, 6).
        task: of the ankles.
        ankles: see `ankle`.
        offset: set (26,) [rad].
    """
    for joint in range(position.size):
        offset[joint] = forces[in_v[joint]]
    fx, fy, fz, nx, ny = forces[0], forces[1], forces[2], forces[3], forces[4]
    lx, ly = _in_base(pelvis, foot_zmps[0])
    rx, ry = _in_base(pelvis, foot_zmps[1])
    left_load = 1.0 - right_load
    # ZMP of the whole body relative to the load-weighted mean of the foot ZMPs.
    dx = -(ny + base * fx) / fz - left_load * lx - right_load * rx
    dy = (nx - base * fy) / fz - left_load * ly - right_load * ry
    for index in range(2):
        load = right_load if index else left_load
        if load > 0.0:
            own = position[6 * index : 6 * index + 6]
            angles = (own[0], own[1], own[2], own[3], own[4], own[5])
            x, y = (rx, ry) if index else (lx, ly)
            point = (x + dx, y + dy, -base)
            force = (load * fx, load * fy, load * fz)
            added = support_torques(_leg(legs, index), angles, point, force)
            for joint in range(6):
                offset[6 * index + joint] += added[joint]
    compliance, lag = servos[0], servos[1]
    for joint in range(position.size):
        offset[joint] = offset[joint] * compliance[joint] + velocity[joint] * lag[joint]
    for index in range(2):
        load = right_load if index else left_load
        if load > 0.0:
            pitch, roll = ankle(task, index, load, ankles)
            offset[6 * index + 4] += pitch
            offset[6 * index + 5] += roll


@njit(cache=True)
def ankle(task: AnkleTask, index: int, load: float, ankles: Array) -> Point:
    """Return the ankle offsets, pitch and roll [rad], that shift the ZMP of a foot.

    Args:
        task: of the ankles.
        index: of the foot.
        load: load fraction of the foot [1].
        ankles: weight of the robot [N]; stiffness of pitch and roll [N m/rad]; gyro damping [s]
            (4,).
    """
    yaw, (dx, dy), gyro = task[0][index], task[1], task[2]
    c, s = cos(yaw), sin(yaw)
    x, y = c * dx + s * dy, c * dy - s * dx
    weight, damping = ankles[0] * load, ankles[3] * load
    return weight / ankles[1] * x + damping * gyro[1], -weight / ankles[2] * y + damping * gyro[0]


@njit(cache=True)
def _leg(legs: Array, index: int) -> Leg:
    leg = legs[index]
    return leg[0], leg[1], leg[2], leg[3], leg[4], leg[5]


@njit(cache=True)
def _in_base(pelvis: Vector, point: Point) -> Point:
    """Express a point of the plan frame in the base frame [m]."""
    c, s = cos(pelvis[2]), sin(pelvis[2])
    x, y = point[0] - pelvis[0], point[1] - pelvis[1]
    return c * x + s * y, c * y - s * x
