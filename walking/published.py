"""Published state of the engine: the plan in the odometry frame, the camera, the limits."""

from math import asin, atan2, cos, sin
from typing import Annotated, Any, cast

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import Records, record_class
from walking.body.kinematics import MOVE, inclined, rotated, rotation_of, times
from walking.command import (
    STRIDE_LIMITS,
    Command,
    CommandLimits,
    CommandState,
    VelocityCommand,
    limits_of,
)
from walking.data import STEPS, Body, Data, DeadReckoning, Gait, MeasuredFoot
from walking.estimate.body import base_height
from walking.estimate.odometry import Odometry
from walking.model import CAMERA, RIGHT, FootholdRecord, Model, Strides
from walking.plan.balance import is_fallen
from walking.plan.footsteps import (
    Foothold,
    command_of,
    command_strides,
    foothold,
    mean_velocity,
    put,
    velocity_strides,
)
from walking.plan.gait import is_double, support_foot, swing_foot
from walking.plan.pendulum import dcm, dcm_of
from walking.plan.steering import twist_of
from walking.plan.support import CORNERS, polygon
from walking.plan.timing import duration
from walking.plane import Array, PlanePose, clamp, from_frame
from walking.state import Balance, HeadCameraPose, Phase, WalkingState

PHASES = (Phase.STANDING, Phase.DOUBLE_SUPPORT, Phase.LEFT_SUPPORT, Phase.RIGHT_SUPPORT)
STANDING, DOUBLE_SUPPORT, LEFT_SUPPORT, RIGHT_SUPPORT = range(len(PHASES))


@record_class
class CameraRecord:
    """`walking.state.HeadCameraPose`, in the same order."""

    rotation: Annotated[Array, 3, 3]
    position: Annotated[Array, 3]  # [m]
    pan: float  # [rad]
    tilt: float  # [rad]
    pan_rate: float  # [rad/s]
    tilt_rate: float  # [rad/s]
    yaw_rate: float  # [rad/s]


@record_class
class OdometryRecord:
    """`walking.estimate.odometry.Odometry`, in the same order."""

    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad]
    covariance: Annotated[Array, 3, 3]  # [m², m rad, rad²]


@record_class
class BalanceRecord:
    """`walking.state.Balance`, in the same order."""

    com: Annotated[Array, 2]  # [m]
    dcm: Annotated[Array, 2]  # [m]
    support: Annotated[Array, CORNERS, 2]  # [m]
    zmp_depth: float  # [m]
    feet: Annotated[Array, 2, 4]  # [m], yaw [rad]
    capture: Annotated[Array, 2]  # [m]


@record_class
class Published:
    """`walking.state.WalkingState`, in the same order, in the odometry frame."""

    phase: int  # index in `PHASES`
    odometry: OdometryRecord
    camera: CameraRecord
    applied_velocity: Annotated[Array, 3]  # [m/s, m/s, rad/s]
    footsteps: Annotated[Records[FootholdRecord], 1 + STEPS]
    zmp: Annotated[Array, 2]  # [m]
    dcm: Annotated[Array, 2]  # [m]
    com: Annotated[Array, 2]  # [m]
    roll: float  # [rad]
    pitch: float  # [rad]
    step_count: int
    fallen: bool
    balance: BalanceRecord
    footstep_count: int
    corner_count: int  # of the support polygon
    bound: int  # limits that bind, as bits
    explicit: bool  # whether the applied command is a command state
    applied: Annotated[Array, 6]  # its numbers


def walking_state(published: Records[Published], commanded: Command) -> WalkingState:
    """Return a published state as a value.

    Args:
        published: state (1,); the arrays of the value are parts of it.
        commanded: last command.
    """
    numbers: Any = cast("NDArray[Any]", published).item()
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
    records: Records[Published],
    walks: Records[Data],
    odometry: Records[DeadReckoning],
    robots: Records[Model],
    rates: Array,
    gyro: Array,
) -> None:
    """Publish the state of a walk.

    Args:
        records: state (1,), set.
        walks: state of the walk (1,).
        odometry: dead reckoning (1,).
        robots: constants (1,).
        rates: measured rates of all joints (n,) [rad/s].
        gyro: angular velocity of the trunk (3,) [rad/s].
    """
    published, walk, robot = records[0], walks[0], robots[0]
    height = base_height(walk.body)
    publish_camera(published.camera, walk.body, height, rates, gyro, robot)
    publish_plan(published, walk, odometry[0], robot)
    publish_limits(published, walk, robot)


@compiled
def publish_plan(published: Published, walk: Data, odometry: DeadReckoning, robot: Model) -> None:
    """Publish measured body and plan.

    The plan is expressed in the odometry frame: its support foot is where odometry measures it.

    Args:
        published: set.
        walk: state of the walk.
        odometry: dead reckoning.
        robot: constants.
    """
    out, balance, plan, body, error = published, published.balance, walk.plan, walk.body, walk.error
    gait = plan.gait
    out.phase, out.step_count, out.fallen = _phase(gait), gait.completed, is_fallen(body, robot)
    out.roll, out.pitch = body.roll, body.pitch
    measured = (odometry.x, odometry.y, odometry.yaw)
    out.odometry.x, out.odometry.y, out.odometry.yaw = measured
    _publish_covariance(out.odometry.covariance, odometry)
    _put_point(out.com, measured, body.com_x, body.com_y)
    for k, value in enumerate(twist_of(walk.placing.applied)):
        out.applied_velocity[k] = value
    frame = _plan_frame(support_foot(gait), body.feet[gait.support], measured)
    p = walk.pendulum
    _put_point(out.zmp, frame, p.zmp_x, p.zmp_y)
    x, y = dcm_of(p, robot)
    _put_point(out.dcm, frame, x, y)
    _put_point(balance.com, frame, p.x, p.y)
    x = dcm(p.x + error.x, p.vx + error.vx, robot)
    y = dcm(p.y + error.y, p.vy + error.vy, robot)
    _put_point(balance.dcm, frame, x, y)
    unloading, loading = foothold(walk.unloading), foothold(walk.loading)
    corners = polygon(robot.support, unloading, loading, walk.single)
    out.corner_count, balance.zmp_depth = corners.shape[0], walk.zmp_depth
    for k in range(corners.shape[0]):
        _put_point(balance.support[k], frame, corners[k, 0], corners[k, 1])
    for side in range(2):
        foot, row = walk.limbs.feet[side], balance.feet[side]
        _put_point(row, frame, foot.x, foot.y)
        row[2], row[3] = foot.height, foot.yaw + frame[2]
    placing = walk.placing
    _put_point(balance.capture, (0.0, 0.0, frame[2]), placing.moved_x, placing.moved_y)
    _put_foothold(out.footsteps[0], frame, support_foot(gait))
    out.footstep_count = 2
    if not gait.stepping:
        _put_foothold(out.footsteps[1], frame, swing_foot(gait))
        return
    out.footstep_count = 1 + plan.step_count
    for k in range(plan.step_count):
        _put_foothold(out.footsteps[1 + k], frame, foothold(plan.steps[k]))


@compiled
def publish_limits(published: Published, walk: Data, robot: Model) -> None:
    """Publish the limits that bind, and if any does, the command that the next footsteps follow."""
    out, steering, timing = published, walk.steering, walk.plan.gait.clock.timing
    out.bound, out.explicit = walk.limits, steering.state.explicit
    if out.bound == 0:
        return
    strides = np.zeros(1, Strides)[0]
    if out.explicit:
        if walk.admission.fraction == 1.0:
            # The footsteps follow the wanted strides, corrected for slip.
            command_strides(strides, steering.state.step, 0.0, robot)
        else:
            strides = walk.plan.following
        command = command_of(strides, timing)
        for k, value in enumerate(command):
            out.applied[k] = value
        return
    velocity = twist_of(walk.placing.applied)
    if out.bound & STRIDE_LIMITS:
        time = duration(timing)
        velocity_strides(strides, velocity, time, robot)
        velocity = mean_velocity(strides, time, robot)
    for k, value in enumerate(velocity):
        out.applied[k] = value


@compiled
def _publish_covariance(covariance: Array, odometry: DeadReckoning) -> None:
    """Set the covariance (3, 3) of odometry."""
    o = odometry
    covariance[0, 0], covariance[0, 1], covariance[0, 2] = o.xx, o.xy, o.xw
    covariance[1, 0], covariance[1, 1], covariance[1, 2] = o.xy, o.yy, o.yw
    covariance[2, 0], covariance[2, 1], covariance[2, 2] = o.xw, o.yw, o.ww


@compiled
def publish_camera(
    camera: CameraRecord, body: Body, height: float, rates: Array, gyro: Array, robot: Model
) -> None:
    """Publish the head camera in the robot frame, level by the IMU.

    Args:
        camera: set.
        body: measured body.
        height: height of the base above the floor [m].
        rates: measured rates of all joints (n,) [rad/s].
        gyro: angular velocity of the trunk (3,) [rad/s].
        robot: constants.
    """
    frame, neck = body.frames[CAMERA], robot.neck
    mounted = rotation_of(frame)
    camera.pan = atan2(mounted[5], mounted[2])
    camera.tilt = asin(clamp(mounted[8], 1.0))
    camera.pan_rate = camera.tilt_rate = 0.0
    if neck.movable:
        camera.pan_rate = neck.pan.sign * rates[neck.pan.joint]
        camera.tilt_rate = neck.tilt.sign * rates[neck.tilt.joint]
    tilt = inclined(body.roll, body.pitch)
    rotation = times(tilt, mounted)
    position = rotated(tilt, frame[MOVE], frame[MOVE + 1], frame[MOVE + 2])
    for i in range(3):
        for j in range(3):
            camera.rotation[i, j] = rotation[3 * i + j]
        camera.position[i] = position[i]
    camera.position[2] += height
    camera.yaw_rate = rotated(tilt, gyro[0], gyro[1], gyro[2])[2]


@compiled
def _phase(gait: Gait) -> int:
    if not gait.stepping:
        return STANDING
    if is_double(gait):
        return DOUBLE_SUPPORT
    return RIGHT_SUPPORT if gait.support == RIGHT else LEFT_SUPPORT


@compiled
def _plan_frame(planned: Foothold, foot: MeasuredFoot, odometry: PlanePose) -> PlanePose:
    """Return the plan frame, given the support foot in the plan and as measured."""
    x, y = from_frame(odometry, foot.x, foot.y)
    yaw = odometry[2] + foot.yaw - planned.yaw
    c, s = cos(yaw), sin(yaw)
    return x - c * planned.x + s * planned.y, y - s * planned.x - c * planned.y, yaw


@compiled
def _put_foothold(record: FootholdRecord, frame: PlanePose, foot: Foothold) -> None:
    x, y = from_frame(frame, foot.x, foot.y)
    put(record, Foothold(foot.left, x, y, foot.yaw + frame[2]))


@compiled
def _put_point(point: Array, frame: PlanePose, x: float, y: float) -> None:
    """Set a point to that at x, y [m] in a frame."""
    point[0], point[1] = from_frame(frame, x, y)
