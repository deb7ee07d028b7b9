"""Servo feed-forward of a control tick, compiled.

Constant numbers are rows of arrays: tuples are unpacked at every call.
"""

from math import cos, sin

from compilation import compiled
from walking.arrays import Array, Indices, Point, Vector

AnkleTask = tuple[Point, Array]
"""Task of the ankles: shift of the ZMP in the plan frame [m]; angular velocity of the trunk to damp
(3,) [rad/s]."""


@compiled
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
        position: joint angles (n,) [rad].
        before: those of the last tick, updated (n,) [rad].
        velocity: joint rates, updated (n,) [rad/s].
        q: position of the model, set.
        v: velocity of the model, set.
        a: acceleration of the model, set.
        in_q: indices of the joints in q (n,).
        in_v: indices of the joints in v and a (n,).
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


@compiled
def offsets(
    forces: Array,
    in_v: Indices,
    velocity: Array,
    servos: Array,
    pelvis: Vector,
    foot_zmps: tuple[Point, Point],
    right_load: float,
    base: float,
    axes: Array,
    origins: Array,
    task: AnkleTask,
    ankles: Array,
    offset: Array,
) -> None:
    """Set the feed-forward offsets against load and lag of the servos.

    Args:
        forces: generalised forces of the motion without contact, force [N] and moment [N m] at the
            base first.
        in_v: indices of the joints in these (n,).
        velocity: joint rates (n,) [rad/s].
        servos: feed-forward per load [rad/(N m)], velocity lag [s], compliance [rad/(N m)] (3, n).
        pelvis: x, y [m], heading [rad] in the plan frame.
        foot_zmps: planned ZMP under each foot, in the plan frame [m].
        right_load: load fraction of the right foot [1].
        base: height of the base above the floor [m].
        axes: of the leg joints in the base frame (2, 6, 3).
        origins: of the leg joints in the base frame (2, 6, 3) [m].
        task: of the ankles.
        ankles: weight of the robot [N]; gyro damping [s]; first joint of the ankle in a leg (3,).
        offset: set (n,) [rad].
    """
    for joint in range(velocity.size):
        offset[joint] = forces[in_v[joint]]
    fx, fy, fz, nx, ny = forces[0], forces[1], forces[2], forces[3], forces[4]
    lx, ly = _in_base(pelvis, foot_zmps[0])
    rx, ry = _in_base(pelvis, foot_zmps[1])
    left_load = 1.0 - right_load
    # ZMP of the whole body relative to the load-weighted mean of the foot ZMPs.
    dx = -(ny + base * fx) / fz - left_load * lx - right_load * rx
    dy = (nx - base * fy) / fz - left_load * ly - right_load * ry
    for side in range(2):
        load = right_load if side else left_load
        if load > 0.0:
            x, y = (rx, ry) if side else (lx, ly)
            point = (x + dx, y + dy, -base)
            force = (load * fx, load * fy, load * fz)
            for k in range(6):
                torque = support_torque(axes[side, k], origins[side, k], point, force)
                offset[6 * side + k] += torque
    for joint in range(velocity.size):
        offset[joint] = offset[joint] * servos[0, joint] + velocity[joint] * servos[1, joint]
    for side in range(2):
        load = right_load if side else left_load
        if load > 0.0:
            for k in range(int(ankles[2]), 6):
                joint = 6 * side + k
                compliance = servos[2, joint]
                offset[joint] += ankle(task, pelvis[2], load, axes[side, k], compliance, ankles)


@compiled
def support_torque(axis: Array, origin: Array, point: Vector, force: Vector) -> float:
    """Return the torque of a joint [N m] of a massless leg that transmits a force to the base.

    Args:
        axis: of the joint in the base frame (3,).
        origin: of the joint in the base frame (3,) [m].
        point: of contact, in the base frame [m].
        force: of the floor on the foot, in the base frame [N].
    """
    x, y, z = point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]
    fx, fy, fz = force
    torque: float = -(
        axis[0] * (y * fz - z * fy) + axis[1] * (z * fx - x * fz) + axis[2] * (x * fy - y * fx)
    )
    return torque


@compiled
def ankle(
    task: AnkleTask, yaw: float, load: float, axis: Array, compliance: float, ankles: Array
) -> float:
    """Return the offset of an ankle joint [rad] that shifts the ZMP of a foot and damps the trunk.

    Args:
        task: of the ankles.
        yaw: of the pelvis in the plan frame [rad].
        load: load fraction of the foot [1].
        axis: of the joint in the base frame (3,).
        compliance: of its servo [rad/(N m)].
        ankles: see `offsets`.
    """
    (dx, dy), gyro = task
    c, s = cos(yaw), sin(yaw)
    x, y = c * dx + s * dy, c * dy - s * dx
    shift: float = ankles[0] * compliance * (axis[1] * x - axis[0] * y)
    damping: float = ankles[1] * (axis[0] * gyro[0] + axis[1] * gyro[1])
    return load * (shift + damping)


@compiled
def _in_base(pelvis: Vector, point: Point) -> Point:
    """Express a point of the plan frame in the base frame [m]."""
    c, s = cos(pelvis[2]), sin(pelvis[2])
    x, y = point[0] - pelvis[0], point[1] - pelvis[1]
    return c * x + s * y, c * y - s * x
