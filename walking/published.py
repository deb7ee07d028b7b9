"""Published state of the engine: the plan in the odometry frame, the camera, the limits."""

from functools import cached_property
from math import asin, atan2, cos, sin
from typing import Any

import numpy as np

from compilation import compiled
from walking.body.kinematics import chain_end
from walking.command import Command, CommandLimits, CommandState, VelocityCommand, limits_of
from walking.foothold import Foothold, foothold, put
from walking.gait import support_foot, swing_foot
from walking.odometry import Odometry
from walking.plane import Array, Indices, Point
from walking.records import FOOTHOLD, LIVE, STEPS, WORD, Record, record
from walking.state import Balance, HeadCameraPose, Phase, WalkingState
from walking.steering import report_applied
from walking.support import CORNERS, polygon

PHASES = (Phase.STANDING, Phase.DOUBLE_SUPPORT, Phase.LEFT_SUPPORT, Phase.RIGHT_SUPPORT)
STANDING, DOUBLE_SUPPORT, LEFT_SUPPORT, RIGHT_SUPPORT = range(len(PHASES))

PUBLISHED = record(
    phase=float,
    x=float,
    y=float,
    yaw=float,
    roll=float,
    pitch=float,
    step_count=float,
    zmp_depth=float,
    corner_count=float,
    bound=float,
    explicit=float,
    pan=float,
    tilt=float,
    pan_rate=float,
    tilt_rate=float,
    yaw_rate=float,
    applied=(float, 6),
    covariance=(float, 3, 3),
    rotation=(float, 3, 3),
    position=(float, 3),
    applied_velocity=(float, 3),
    zmp=(float, 2),
    dcm=(float, 2),
    com=(float, 2),
    planned_com=(float, 2),
    measured_dcm=(float, 2),
    corners=(float, CORNERS, 2),
    feet=(float, 2, 4),
    capture=(float, 2),
)
"""`walking.state.WalkingState`, in the odometry frame; numbers only, the flags, too."""

_WORDS = PUBLISHED.itemsize // WORD
_FIELDS: Any = PUBLISHED.fields
_SCALARS = sum(not kind.shape for kind, *_ in _FIELDS.values())
_ARRAYS = {
    name: (slice(offset // WORD, (offset + kind.itemsize) // WORD), kind.shape)
    for name, (kind, offset, *_) in _FIELDS.items()
    if kind.shape
}
_DEPTH, _BOUND = (_FIELDS[name][1] // WORD for name in ("zmp_depth", "bound"))

PlanFrame = tuple[float, float, float, float, float]
"""Origin x, y [m], cosine and sine of the direction, and the direction [rad] of the plan frame."""


class Publication:
    """Buffer that `publish` and `report` fill, and the states made of it.

    Attributes:
        records: record `PUBLISHED` (1,).
        footsteps: planned footholds, the support foot first (n,).
    """

    def __init__(self) -> None:
        self._numbers = np.zeros(_WORDS)
        self.records: Record = self._numbers.view(PUBLISHED)
        self.footsteps: Record = np.zeros(1 + STEPS, FOOTHOLD)

    def state(self, count: int, commanded: Command, *, fallen: bool) -> WalkingState:
        """Return the state.

        Args:
            count: number of footsteps.
            commanded: last command.
            fallen: whether the robot believes that it has fallen.
        """
        return PublishedState.of(
            self._numbers.copy(), self.footsteps[:count].copy(), commanded, fallen=fallen
        )

    def report(self, commanded: Command) -> CommandLimits:
        """Return the report of how a command is limited."""
        return _report(self._numbers, commanded)


class PublishedState(WalkingState):
    """State over a copy of the buffer; what few read becomes an object when it is read."""

    _numbers: Array
    _steps: Record
    _commanded: Command

    @classmethod
    def of(cls, numbers: Array, steps: Record, commanded: Command, *, fallen: bool) -> WalkingState:
        """Make a state of the numbers of a record `PUBLISHED`.

        Args:
            numbers: the record as an array (n,), kept.
            steps: planned footholds, the support foot first, kept (k,).
            commanded: last command.
            fallen: whether the robot believes that it has fallen.
        """
        state: Any = cls.__new__(cls)
        state._numbers, state._steps, state._commanded = numbers, steps, commanded
        phase, x, y, yaw, roll, pitch, step_count, _, _, _, _, *camera = numbers[:_SCALARS].tolist()
        state.phase = PHASES[int(phase)]
        state.odometry = Odometry(x, y, yaw, _array(numbers, "covariance"))
        rotation, position = _array(numbers, "rotation"), _array(numbers, "position")
        state.camera = HeadCameraPose(rotation, position, *camera)
        state.roll, state.pitch, state.step_count = roll, pitch, int(step_count)
        state.fallen = fallen
        made: WalkingState = state
        return made

    @cached_property
    def footsteps(self) -> tuple[Foothold, ...]:
        """Planned footholds, the support foot first."""
        return tuple(map(Foothold._make, self._steps.tolist()))

    @cached_property
    def applied_velocity(self) -> Array:
        """Velocity that the footsteps follow (3,) [m/s, m/s, rad/s]."""
        return _array(self._numbers, "applied_velocity")

    @cached_property
    def zmp(self) -> Array:
        """Planned zero-moment point (2,) [m]."""
        return _array(self._numbers, "zmp")

    @cached_property
    def dcm(self) -> Array:
        """Planned divergent component of motion (2,) [m]."""
        return _array(self._numbers, "dcm")

    @cached_property
    def com(self) -> Array:
        """Measured centre of mass (2,) [m]."""
        return _array(self._numbers, "com")

    @cached_property
    def balance(self) -> Balance:
        """Planned and measured motion in detail."""
        numbers = self._numbers
        zmp_depth, corner_count = numbers[_DEPTH : _DEPTH + 2].tolist()
        return Balance(
            com=_array(numbers, "planned_com"),
            dcm=_array(numbers, "measured_dcm"),
            support=_array(numbers, "corners")[: int(corner_count)],
            zmp_depth=zmp_depth,
            feet=_array(numbers, "feet"),
            capture=_array(numbers, "capture"),
        )

    @cached_property
    def command_limits(self) -> CommandLimits:
        """How the last command was limited."""
        return _report(self._numbers, self._commanded)


def _array(numbers: Array, name: str) -> Array:
    """Return an array of a record `PUBLISHED`."""
    part, shape = _ARRAYS[name]
    return numbers[part].reshape(shape)


def _report(numbers: Array, commanded: Command) -> CommandLimits:
    """Return how a command is limited."""
    bound, explicit = numbers[_BOUND : _BOUND + 2].tolist()
    if bound == 0.0:
        return CommandLimits(commanded, commanded, ())
    values = _array(numbers, "applied").tolist()
    command = CommandState(*values) if explicit else VelocityCommand(*values[:3])
    return CommandLimits(commanded, command, limits_of(int(bound)))


@compiled
def publish(
    records: Record,
    footsteps: Record,
    walks: Record,
    plans: Record,
    odometry: Record,
    robots: Record,
    angles: Array,
    rates: Array,
    gyro: Array,
    chain: Array,
    moving: Indices,
) -> int:
    """Publish the state of a walk; return the number of footsteps.

    Args:
        records: record `PUBLISHED` (1,), set.
        footsteps: planned footholds, the support foot first, set (n,).
        walks: state of the walk (1,).
        plans: plans of the walk (3,).
        odometry: dead reckoning (1,).
        robots: constants (1,).
        angles: measured angles of all joints (n,) [rad].
        rates: measured rates of all joints (n,) [rad/s].
        gyro: angular velocity of the trunk (3,) [rad/s].
        chain: chain from the base to the camera, see `walking.body.kinematics`.
        moving: joints of the chain.
    """
    published, walk, robot = records[0], walks[0], robots[0]
    publish_camera(published, walk.sensing, angles, rates, gyro, chain, moving, robot)
    return publish_plan(published, footsteps, walk, plans[LIVE], odometry[0], robot)


@compiled
def report(
    records: Record,
    walks: Record,
    plans: Record,
    robots: Record,
) -> None:
    """Publish the applied command and the limits that bind, see `publish`."""
    publish_limits(records[0], walks[0], plans[LIVE], robots[0])


@compiled
def publish_plan(
    published: Record,
    footsteps: Record,
    walk: Record,
    plan: Record,
    odometry: Record,
    robot: Record,
) -> int:
    """Publish all but the camera; return the number of footsteps.

    The plan is expressed in the odometry frame: its support foot is where odometry measures it.

    Args:
        published: set.
        footsteps: planned footholds, support foot first, set (n,).
        walk: state of the walk.
        plan: plan in force.
        odometry: dead reckoning.
        robot: constants.
    """
    out, gait, sensing, o = published, plan.gait, walk.sensing, odometry
    out.phase = _phase(gait)
    out.x, out.y, out.yaw = o.x, o.y, o.yaw
    publish_covariance(out.covariance, o)
    out.roll, out.pitch, out.step_count = sensing.roll, sensing.pitch, gait.completed
    for k in range(3):
        out.applied_velocity[k] = walk.placing.applied[k]
    frame = _plan_frame(support_foot(gait), sensing.feet[gait.support], odometry)
    p, w = walk.pendulum, robot.omega
    _put_point(out.zmp, frame, p.zmp_x, p.zmp_y)
    _put_point(out.dcm, frame, p.x + p.vx / w, p.y + p.vy / w)
    _put_point(out.planned_com, frame, p.x, p.y)
    x = p.x + sensing.x + (p.vx + sensing.vx) / w
    y = p.y + sensing.y + (p.vy + sensing.vy) / w
    _put_point(out.measured_dcm, frame, x, y)
    unloading, loading = foothold(walk.unloading), foothold(walk.loading)
    corners = polygon(robot.support, unloading, loading, walk.single)
    out.corner_count, out.zmp_depth = corners.shape[0], walk.zmp_depth
    for k in range(corners.shape[0]):
        _put_point(out.corners[k], frame, corners[k, 0], corners[k, 1])
    for side in range(2):
        foot, row = walk.limbs.feet[side], out.feet[side]
        _put_point(row, frame, foot.x, foot.y)
        row[2], row[3] = foot.height, foot.yaw + frame[4]
    _, _, c, s, _ = frame
    dx, dy = walk.placing.moved_x, walk.placing.moved_y
    out.capture[0], out.capture[1] = c * dx - s * dy, s * dx + c * dy
    c, s = cos(o.yaw), sin(o.yaw)
    out.com[0] = o.x + c * sensing.com[0] - s * sensing.com[1]
    out.com[1] = o.y + s * sensing.com[0] + c * sensing.com[1]
    publish_limits(out, walk, plan, robot)
    _put_foothold(footsteps[0], frame, support_foot(gait))
    if not gait.stepping:
        _put_foothold(footsteps[1], frame, swing_foot(gait))
        return 2
    for k in range(plan.step_count):
        _put_foothold(footsteps[1 + k], frame, foothold(plan.steps[k]))
    count: int = 1 + plan.step_count
    return count


@compiled
def publish_limits(published: Record, walk: Record, plan: Record, robot: Record) -> None:
    """Publish the applied command and the limits that bind."""
    admission, placing = walk.admission, walk.placing
    bound = walk.steering.bound | walk.bound | placing.bound
    report_applied(
        walk.applied,
        walk.steering,
        walk.scratch,
        bound,
        (placing.applied[0], placing.applied[1], placing.applied[2]),
        admission.known and admission.fraction < 1.0,
        admission.following,
        plan.gait.clock.timing,
        robot,
    )
    published.bound, published.explicit = bound, walk.applied.explicit
    for k in range(6):
        published.applied[k] = walk.applied.values[k]


@compiled
def publish_covariance(covariance: Array, odometry: Record) -> None:
    """Set the covariance (3, 3) of odometry."""
    o = odometry
    covariance[0, 0], covariance[0, 1], covariance[0, 2] = o.xx, o.xy, o.xw
    covariance[1, 0], covariance[1, 1], covariance[1, 2] = o.xy, o.yy, o.yw
    covariance[2, 0], covariance[2, 1], covariance[2, 2] = o.xw, o.yw, o.ww


@compiled
def publish_camera(
    camera: Record,
    sensing: Record,
    angles: Array,
    rates: Array,
    gyro: Array,
    chain: Array,
    moving: Indices,
    robot: Record,
) -> None:
    """Publish the head camera in the robot frame: tilt by IMU, height by the loaded leg.

    Args:
        camera: set.
        sensing: measured body.
        angles: measured angles of all joints (n,) [rad].
        rates: measured rates of all joints (n,) [rad/s].
        gyro: angular velocity of the trunk (3,) [rad/s].
        chain: chain from the base to the camera, see `walking.body.kinematics`.
        moving: joints of the chain.
        robot: constants.
    """
    mounted, origin, own = np.empty((3, 3)), np.empty(3), np.empty(moving.size)
    for k in range(moving.size):
        own[k] = angles[moving[k]]
    chain_end(chain, own, mounted, origin)
    camera.pan = atan2(mounted[1, 2], mounted[0, 2])
    camera.tilt = asin(min(1.0, max(-1.0, mounted[2, 2])))
    neck = robot.neck
    camera.pan_rate = camera.tilt_rate = 0.0
    if neck.movable:
        camera.pan_rate = neck.pan_sign * rates[neck.pan_joint]
        camera.tilt_rate = neck.tilt_sign * rates[neck.tilt_joint]
    tilt, load = (sensing.roll, sensing.pitch), sensing.right_load
    camera.yaw_rate = level_camera(tilt, mounted, origin, gyro, camera.rotation, camera.position)
    camera.position[2] += -(1.0 - load) * sensing.feet[0].z - load * sensing.feet[1].z


@compiled
def level_camera(
    tilt: Point, mounted: Array, origin: Array, gyro: Array, rotation: Array, position: Array
) -> float:
    """Express the camera in the level frame of the trunk's heading.

    Args:
        tilt: roll and pitch of the trunk [rad].
        mounted: rotation R_BC of the camera in the base frame (3, 3).
        origin: position p_BC of the camera in the base frame (3,) [m].
        gyro: angular velocity of the trunk in its frame (3,) [rad/s].
        rotation: set to R_RC (3, 3).
        position: set to p_RC (3,) [m].

    Returns:
        yaw rate of the trunk [rad/s].
    """
    R = np.empty((3, 3))
    incline(tilt[0], tilt[1], R)
    for i in range(3):
        for j in range(3):
            rotation[i, j] = (
                R[i, 0] * mounted[0, j] + R[i, 1] * mounted[1, j] + R[i, 2] * mounted[2, j]
            )
        position[i] = R[i, 0] * origin[0] + R[i, 1] * origin[1] + R[i, 2] * origin[2]
    yaw_rate: float = R[2, 0] * gyro[0] + R[2, 1] * gyro[1] + R[2, 2] * gyro[2]
    return yaw_rate


@compiled
def incline(roll: float, pitch: float, rotation: Array) -> None:
    """Set the attitude R_RB (3, 3) of a trunk with roll and pitch [rad]."""
    cr, sr, cp, sp = cos(roll), sin(roll), cos(pitch), sin(pitch)
    rotation[0, 0], rotation[0, 1], rotation[0, 2] = cp, sp * sr, sp * cr
    rotation[1, 0], rotation[1, 1], rotation[1, 2] = 0.0, cr, -sr
    rotation[2, 0], rotation[2, 1], rotation[2, 2] = -sp, cp * sr, cp * cr


@compiled
def _phase(gait: Record) -> int:
    if not gait.stepping:
        return STANDING
    if gait.double:
        return DOUBLE_SUPPORT
    return RIGHT_SUPPORT if gait.support == 1 else LEFT_SUPPORT


@compiled
def _plan_frame(planned: Foothold, foot: Record, odometry: Record) -> PlanFrame:
    """Return the plan frame, given the support foot in the plan and as measured."""
    c, s = cos(odometry.yaw), sin(odometry.yaw)
    yaw = odometry.yaw + foot.yaw - planned.yaw
    cy, sy = cos(yaw), sin(yaw)
    return (
        odometry.x + c * foot.x - s * foot.y - cy * planned.x + sy * planned.y,
        odometry.y + s * foot.x + c * foot.y - sy * planned.x - cy * planned.y,
        cy,
        sy,
        yaw,
    )


@compiled
def _transformed(frame: PlanFrame, x: float, y: float) -> Point:
    ox, oy, c, s, _ = frame
    return ox + c * x - s * y, oy + s * x + c * y


@compiled
def _put_point(point: Array, frame: PlanFrame, x: float, y: float) -> None:
    point[0], point[1] = _transformed(frame, x, y)


@compiled
def _put_foothold(record: Record, frame: PlanFrame, foot: Foothold) -> None:
    x, y = _transformed(frame, foot.x, foot.y)
    put(record, Foothold(foot.left, x, y, foot.yaw + frame[4]))
