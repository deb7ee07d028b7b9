"""Servo feed-forward: offsets of the setpoints against compliance and lag of the position servos.

Inverse dynamics gives the contact wrench of the whole-body motion; the legs share it by load, with
the force under each sole at the planned ZMP. The ankles shift the ZMP of the loaded feet against
the DCM error and damp the trunk.
"""

from compilation import compiled
from compilation.record import record_type
from walking.parameters import CONTROL_PERIOD
from walking.plane import Array, Point, Vector, clamp, rotate_back
from walking.records import Record

JOINT = record_type(
    lower=float,
    upper=float,
    lag=float,
    compliance=float,
    ready=float,
    in_q=int,
    in_v=int,
    angle=float,
    rate=float,
    rate_ahead=float,
    offset=float,
)
"""Joint: limits [rad], velocity lag [s], compliance [rad/(N m)], angle of the ready posture [rad],
indices in position and velocity of the dynamic model; planned angle [rad] and rate [rad/s], rate
for the feed-forward [rad/s], feed-forward offset [rad]."""

LEG_JOINTS = 6
HIP_JOINTS = 3  # first joints of a leg


@compiled
def set_motion(
    joints: Record,
    angles: Array,
    q: Array,
    v: Array,
    a: Array,
    yaw: float,
    acceleration: Point,
    robot: Record,
) -> None:
    """Differentiate the joint angles and set the motion of the dynamic model.

    Args:
        joints: planned angles and rates, changed (n,).
        angles: planned angles of this tick (n,) [rad].
        q: position of the dynamic model, set.
        v: velocity of the dynamic model, set.
        a: acceleration of the dynamic model, set.
        yaw: heading of the pelvis in the plan frame [rad].
        acceleration: planned acceleration of the base in the plan frame [m/s²].
        robot: constants.
    """
    p = robot.stabilizer
    a[0], a[1] = rotate_back(yaw, acceleration[0], acceleration[1])
    for k in range(angles.size):
        joint = joints[k]
        rate = (angles[k] - joint.angle) / CONTROL_PERIOD
        change = p.inertia_gain * (rate - joint.rate) / CONTROL_PERIOD
        joint.rate, joint.angle = rate, angles[k]
        q[joint.in_q], v[joint.in_v] = angles[k], rate
        a[joint.in_v] = clamp(change, p.max_inertia_acceleration)
        joint.rate_ahead = rate + p.velocity_ahead * a[joint.in_v]


@compiled
def set_offsets(
    joints: Record,
    walk: Record,
    forces: Array,
    gyro: Array,
    foot_zmps: tuple[Point, Point],
    robot: Record,
) -> None:
    """Set the feed-forward offsets of all setpoints.

    Args:
        joints: offsets are set (n,).
        walk: pelvis, load and ZMP shift of this tick.
        forces: generalised forces of the motion without contact, force [N] and moment [N m] at the
            base first.
        gyro: angular velocity of the trunk (3,) [rad/s].
        foot_zmps: planned ZMP under each foot, in the plan frame [m].
        robot: constants.
    """
    limbs, height = walk.limbs, robot.height
    axes, origins = limbs.axes, limbs.origins
    right_load = limbs.load
    left_load = 1.0 - right_load
    for k in range(joints.size):
        joints[k].offset = forces[joints[k].in_v]
    fx, fy, fz, nx, ny = forces[0], forces[1], forces[2], forces[3], forces[4]
    lx, ly = _in_base(limbs.pelvis, foot_zmps[0])
    rx, ry = _in_base(limbs.pelvis, foot_zmps[1])
    # ZMP of the whole body relative to the load-weighted mean of the foot ZMPs.
    dx = -(ny + height * fx) / fz - left_load * lx - right_load * rx
    dy = (nx - height * fy) / fz - left_load * ly - right_load * ry
    for side in range(2):
        load = right_load if side == 1 else left_load
        if load > 0.0:
            x, y = (rx, ry) if side == 1 else (lx, ly)
            point = (x + dx, y + dy, -height)
            force = (load * fx, load * fy, load * fz)
            for k in range(LEG_JOINTS):
                torque = support_torque(axes[side, k], origins[side, k], point, force)
                joints[LEG_JOINTS * side + k].offset += torque
    for k in range(joints.size):
        joint = joints[k]
        joint.offset = joint.offset * joint.compliance + joint.rate_ahead * joint.lag
    shift = rotate_back(limbs.pelvis[2], walk.zmp_shift_x, walk.zmp_shift_y)
    for side in range(2):
        load = right_load if side == 1 else left_load
        if load > 0.0:
            for k in range(robot.ankle, LEG_JOINTS):
                joint = joints[LEG_JOINTS * side + k]
                axis, compliance = axes[side, k], joint.compliance
                offset = ankle_offset(axis, shift, gyro, compliance, robot)
                joint.offset += load * offset
            for k in range(HIP_JOINTS):
                offset = hip_offset(axes[side, k], walk.sensing, gyro, robot)
                joints[LEG_JOINTS * side + k].offset += load * offset


@compiled
def support_torque(axis: Array, origin: Array, point: Vector, force: Vector) -> float:
    """Return the torque of a joint [N m] of a massless leg that transmits a force to the base.

    Args:
        axis: axis of the joint in the base frame (3,).
        origin: origin of the joint in the base frame (3,) [m].
        point: point of contact, in the base frame [m].
        force: force of the floor on the foot, in the base frame [N].
    """
    x, y, z = point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]
    fx, fy, fz = force
    torque: float = -(
        axis[0] * (y * fz - z * fy) + axis[1] * (z * fx - x * fz) + axis[2] * (x * fy - y * fx)
    )
    return torque


@compiled
def ankle_offset(axis: Array, shift: Point, gyro: Array, compliance: float, robot: Record) -> float:
    """Return the offset of an ankle joint [rad] that shifts the ZMP of a foot and damps the trunk.

    Args:
        axis: axis of the joint in the base frame (3,).
        shift: shift of the ZMP in the base frame [m].
        gyro: angular velocity of the trunk to damp (3,) [rad/s].
        compliance: compliance of the servo [rad/(N m)].
        robot: constants.
    """
    moved = robot.weight * compliance * (axis[1] * shift[0] - axis[0] * shift[1])
    damping = robot.stabilizer.gyro_gain * (axis[0] * gyro[0] + axis[1] * gyro[1])
    offset: float = moved + damping
    return offset


@compiled
def hip_offset(axis: Array, sensing: Record, gyro: Array, robot: Record) -> float:
    """Return the offset of a hip joint [rad] that turns the trunk upright on its stance leg.

    Where ankle or knee give way, or the foot tips, the trunk tilts with the leg although the hip
    has its planned angle.

    Args:
        axis: axis of the joint in the base frame (3,).
        sensing: measured tilt of the trunk.
        gyro: angular velocity of the trunk (3,) [rad/s].
        robot: constants.
    """
    p = robot.stabilizer
    roll = sensing.roll + p.hip_damping * gyro[0]
    pitch = sensing.pitch + p.hip_damping * gyro[1]
    offset: float = p.hip_gain * (axis[0] * roll + axis[1] * pitch)
    return offset


@compiled
def set_setpoints(
    joints: Record, angles: Array, measured: Array, setpoint: Array, robot: Record
) -> None:
    """Set the setpoints of the servos within the ranges of the joints.

    Args:
        joints: joints of the robot, with their offsets (n,).
        angles: planned angles (n,) [rad].
        measured: measured angles (n,) [rad].
        setpoint: set (n,) [rad].
        robot: constants.
    """
    for k in range(joints.size):
        joint = joints[k]
        goal = min(joint.upper, max(joint.lower, angles[k] + joint.offset))
        if robot.stiffening > 1.0 and k < 2 * LEG_JOINTS:
            goal += (robot.stiffening - 1.0) * (goal - measured[k])
        setpoint[k] = goal


@compiled
def _in_base(pelvis: Array, point: Point) -> Point:
    """Express a point of the plan frame in the base frame [m]."""
    return rotate_back(pelvis[2], point[0] - pelvis[0], point[1] - pelvis[1])
