"""Published state of the engine: the plan in the odometry frame, the camera, the limits."""

from math import asin, atan2, cos, sin
from typing import Any

from compilation import compiled
from compilation.record import record_type
from walking.body.kinematics import MOVE, inclined, rotation_of, times, turned
from walking.command import (
    STRIDE_LIMITS,
    Command,
    CommandLimits,
    CommandState,
    VelocityCommand,
    limits_of,
)
from walking.estimation import CAMERA_FRAME, base_height, is_fallen
from walking.footsteps import (
    FOOTHOLD,
    Foothold,
    command_of,
    command_strides,
    foothold,
    mean_velocity,
    put,
    velocity_strides,
)
from walking.gait import support_foot, swing_foot
from walking.odometry import Odometry
from walking.plane import Array, Frame, from_frame, rotate
from walking.records import Record
from walking.reference import LIVE, STEPS
from walking.state import Balance, HeadCameraPose, Phase, WalkingState
from walking.support import CORNERS, polygon
from walking.timing import duration

PHASES = (Phase.STANDING, Phase.DOUBLE_SUPPORT, Phase.LEFT_SUPPORT, Phase.RIGHT_SUPPORT)
STANDING, DOUBLE_SUPPORT, LEFT_SUPPORT, RIGHT_SUPPORT = range(len(PHASES))

CAMERA = record_type(
    rotation=(float, 3, 3),
    position=(float, 3),
    pan=float,
    tilt=float,
    pan_rate=float,
    tilt_rate=float,
    yaw_rate=float,
)
"""`walking.state.HeadCameraPose`, in the same order."""

PUBLISHED = record_type(
    phase=int,
    odometry=record_type(x=float, y=float, yaw=float, covariance=(float, 3, 3)),
    camera=CAMERA,
    applied_velocity=(float, 3),
    footsteps=(FOOTHOLD, 1 + STEPS),
    zmp=(float, 2),
    dcm=(float, 2),
    com=(float, 2),
    roll=float,
    pitch=float,
    step_count=int,
    fallen=bool,
    balance=record_type(
        com=(float, 2),
        dcm=(float, 2),
        support=(float, CORNERS, 2),
        zmp_depth=float,
        feet=(float, 2, 4),
        capture=(float, 2),
    ),
    # Numbers of footsteps and corners; limits that bind, as bits; whether the applied command is a
    # command state, and its numbers.
    footstep_count=int,
    corner_count=int,
    bound=int,
    explicit=bool,
    applied=(float, 6),
)
"""`walking.state.WalkingState`, in the same order, in the odometry frame."""


def walking_state(published: Record, commanded: Command) -> WalkingState:
    """Return a published state as a value.

    Args:
        published: record `PUBLISHED` (1,); the arrays of the state are parts of it.
        commanded: last command.
    """
    numbers: Any = published.item()
    phase, odometry, camera, velocity, footsteps, *rest, balance = numbers[:13]
    footstep_count, corner_count, bound, explicit, applied = numbers[13:]
    com, dcm, support, *others = balance
    applied_command = commanded
    if bound:
        values = applied.tolist()
        applied_command = CommandState(*values) if explicit else VelocityCommand(*values[:3])
    fields: Any = (
        PHASES[phase],
        Odometry(*odometry),
        HeadCameraPose(*camera),
        velocity,
        tuple(map(Foothold._make, footsteps[:footstep_count].tolist())),
        *rest,
        Balance(com, dcm, support[:corner_count], *others),
        CommandLimits(commanded, applied_command, limits_of(bound)),
    )
    return WalkingState(*fields)


@compiled
def publish(
    records: Record,
    walks: Record,
    plans: Record,
    odometry: Record,
    robots: Record,
    rates: Array,
    gyro: Array,
) -> None:
    """Publish the state of a walk.

    Args:
        records: record `PUBLISHED` (1,), set.
        walks: state of the walk (1,).
        plans: plans of the walk (4,), see `walking.reference.LIVE`.
        odometry: dead reckoning (1,).
        robots: constants (1,).
        rates: measured rates of all joints (n,) [rad/s].
        gyro: angular velocity of the trunk (3,) [rad/s].
    """
    published, walk, plan, robot = records[0], walks[0], plans[LIVE], robots[0]
    height = base_height(walk.sensing)
    publish_camera(published.camera, walk.sensing, height, rates, gyro, robot)
    publish_plan(published, walk, plan, odometry[0], robot)
    publish_limits(published, walk, plan, robot)


@compiled
def publish_plan(
    published: Record, walk: Record, plan: Record, odometry: Record, robot: Record
) -> None:
    """Publish measured body and plan.

    The plan is expressed in the odometry frame: its support foot is where odometry measures it.

    Args:
        published: record `PUBLISHED`, set.
        walk: state of the walk.
        plan: plan in force.
        odometry: dead reckoning.
        robot: constants.
    """
    out, balance, gait, sensing = published, published.balance, plan.gait, walk.sensing
    out.phase, out.step_count, out.fallen = _phase(gait), gait.completed, is_fallen(sensing, robot)
    out.roll, out.pitch = sensing.roll, sensing.pitch
    measured = (odometry.x, odometry.y, odometry.yaw)
    out.odometry.x, out.odometry.y, out.odometry.yaw = measured
    _publish_covariance(out.odometry.covariance, odometry)
    out.com[0], out.com[1] = from_frame(measured, sensing.com[0], sensing.com[1])
    for k in range(3):
        out.applied_velocity[k] = walk.placing.applied[k]
    frame = _plan_frame(support_foot(gait), sensing.feet[gait.support], measured)
    p, w = walk.pendulum, robot.omega
    out.zmp[0], out.zmp[1] = from_frame(frame, p.zmp_x, p.zmp_y)
    out.dcm[0], out.dcm[1] = from_frame(frame, p.x + p.vx / w, p.y + p.vy / w)
    balance.com[0], balance.com[1] = from_frame(frame, p.x, p.y)
    x = p.x + sensing.x + (p.vx + sensing.vx) / w
    y = p.y + sensing.y + (p.vy + sensing.vy) / w
    balance.dcm[0], balance.dcm[1] = from_frame(frame, x, y)
    unloading, loading = foothold(walk.unloading), foothold(walk.loading)
    corners = polygon(robot.support, unloading, loading, walk.single)
    out.corner_count, balance.zmp_depth = corners.shape[0], walk.zmp_depth
    for k in range(corners.shape[0]):
        corner = balance.support[k]
        corner[0], corner[1] = from_frame(frame, corners[k, 0], corners[k, 1])
    for side in range(2):
        foot, row = walk.limbs.feet[side], balance.feet[side]
        row[0], row[1] = from_frame(frame, foot.x, foot.y)
        row[2], row[3] = foot.height, foot.yaw + frame[2]
    placing = walk.placing
    balance.capture[0], balance.capture[1] = rotate(frame[2], placing.moved_x, placing.moved_y)
    _put_foothold(out.footsteps[0], frame, support_foot(gait))
    out.footstep_count = 2
    if not gait.stepping:
        _put_foothold(out.footsteps[1], frame, swing_foot(gait))
        return
    out.footstep_count = 1 + plan.step_count
    for k in range(plan.step_count):
        _put_foothold(out.footsteps[1 + k], frame, foothold(plan.steps[k]))


@compiled
def publish_limits(published: Record, walk: Record, plan: Record, robot: Record) -> None:
    """Publish the limits that bind, and if any does, the command that the next footsteps follow."""
    out, steering, placing, timing = published, walk.steering, walk.placing, plan.gait.clock.timing
    out.bound, out.explicit = steering.bound | walk.bound | placing.bound, steering.state.explicit
    if out.bound == 0:
        return
    if out.explicit:
        strides = plan.following
        if walk.admission.fraction == 1.0:
            # The footsteps follow the wanted strides, corrected for slip.
            strides = steering.scratch
            command_strides(strides, steering.state.values, 0.0, robot)
        command = command_of(strides, timing)
        for k in range(6):
            out.applied[k] = command[k]
        return
    velocity = (placing.applied[0], placing.applied[1], placing.applied[2])
    if out.bound & STRIDE_LIMITS:
        time = duration(timing)
        velocity_strides(steering.scratch, velocity, time, robot)
        velocity = mean_velocity(steering.scratch, time, robot)
    for k in range(3):
        out.applied[k] = velocity[k]


@compiled
def _publish_covariance(covariance: Array, odometry: Record) -> None:
    """Set the covariance (3, 3) of odometry."""
    o = odometry
    covariance[0, 0], covariance[0, 1], covariance[0, 2] = o.xx, o.xy, o.xw
    covariance[1, 0], covariance[1, 1], covariance[1, 2] = o.xy, o.yy, o.yw
    covariance[2, 0], covariance[2, 1], covariance[2, 2] = o.xw, o.yw, o.ww


@compiled
def publish_camera(
    camera: Record, sensing: Record, height: float, rates: Array, gyro: Array, robot: Record
) -> None:
    """Publish the head camera in the robot frame, level by the IMU.

    Args:
        camera: set.
        sensing: measured body.
        height: height of the base above the floor [m].
        rates: measured rates of all joints (n,) [rad/s].
        gyro: angular velocity of the trunk (3,) [rad/s].
        robot: constants.
    """
    frame, neck = sensing.frames[CAMERA_FRAME], robot.neck
    mounted = rotation_of(frame)
    camera.pan = atan2(mounted[5], mounted[2])
    camera.tilt = asin(min(1.0, max(-1.0, mounted[8])))
    camera.pan_rate = camera.tilt_rate = 0.0
    if neck.movable:
        camera.pan_rate = neck.pan_sign * rates[neck.pan_joint]
        camera.tilt_rate = neck.tilt_sign * rates[neck.tilt_joint]
    tilt = inclined(sensing.roll, sensing.pitch)
    rotation = times(tilt, mounted)
    position = turned(tilt, frame[MOVE], frame[MOVE + 1], frame[MOVE + 2])
    for i in range(3):
        for j in range(3):
            camera.rotation[i, j] = rotation[3 * i + j]
        camera.position[i] = position[i]
    camera.position[2] += height
    camera.yaw_rate = turned(tilt, gyro[0], gyro[1], gyro[2])[2]


@compiled
def _phase(gait: Record) -> int:
    if not gait.stepping:
        return STANDING
    if gait.double:
        return DOUBLE_SUPPORT
    return RIGHT_SUPPORT if gait.support == 1 else LEFT_SUPPORT


@compiled
def _plan_frame(planned: Foothold, foot: Record, odometry: Frame) -> Frame:
    """Return the plan frame, given the support foot in the plan and as measured."""
    x, y = from_frame(odometry, foot.x, foot.y)
    yaw = odometry[2] + foot.yaw - planned.yaw
    c, s = cos(yaw), sin(yaw)
    return x - c * planned.x + s * planned.y, y - s * planned.x - c * planned.y, yaw


@compiled
def _put_foothold(record: Record, frame: Frame, foot: Foothold) -> None:
    x, y = from_frame(frame, foot.x, foot.y)
    put(record, Foothold(foot.left, x, y, foot.yaw + frame[2]))
