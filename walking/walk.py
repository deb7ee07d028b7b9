"""Control tick of the walk: plan, inverse dynamics, setpoints.

`measure_body` measures the body; `plan_tick` estimates, decides, plans, and sets the
posture and its rates; after inverse dynamics `set_setpoints` adds the feed-forward.
"""

from typing import NamedTuple

import numpy as np

from compilation import compiled
from compilation.record import Records
from walking.body.feedforward import set_motion, set_offsets, set_within_range
from walking.body.kinematics import tree_pass
from walking.body.posture import advance_head, head_joints, pelvis_over, set_posture
from walking.body.robot_model import RobotModel
from walking.body.swing_reaction import compensate
from walking.command import FALLEN, SWING_HEIGHT
from walking.data import Data, DeadReckoning, Gait
from walking.estimate.body import measure, reckon_body, update_error
from walking.model import LEFT, RIGHT, Joint, Link, Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.admission import remember
from walking.plan.balance import follow_body, is_fallen, place_foot, zmp_shift
from walking.plan.corrections import restart_cycle
from walking.plan.decision import detect_touchdown, follow, start_walk, want_strides
from walking.plan.departure import end_capture
from walking.plan.footsteps import STILL, Foothold, StepValues, foothold, put
from walking.plan.gait import advance, is_double, stand, support_foot, swing_foot, zmp_under
from walking.plan.generator import advance_pendulum
from walking.plan.reference import plan_walk
from walking.plan.support import Region, depth, load_fraction, polygon, support_region
from walking.plan.swing import rest_at
from walking.plan.timing import cadence, put_timing
from walking.plane import Array, Indices, Point, rotate
from walking.state import BodySensors

SAME_HEIGHT = 1e-9  # rounding error of swing heights [m]
DIVERGED = 10.0  # distance of the pendulum from the support foot per length of the leg [1]


class Parts(NamedTuple):
    """Parts of a robot of variable length.

    Attributes:
        joints: joints of the robot (n,).
        links: links of the robot (n + 1,).
        order: order of the joints, see `walking.body.kinematics.tree_pass` (n, 2).
        q: position of the dynamic model.
        v: velocity of the dynamic model.
        a: acceleration of the dynamic model.
    """

    joints: Records[Joint]
    links: Records[Link]
    order: Indices
    q: Array
    v: Array
    a: Array


@compiled
def stand_ready(walks: Records[Data], stance: Array, robots: Records[Model]) -> None:
    """Set the state of a robot that stands in the ready posture.

    Args:
        walks: state (1,), changed.
        stance: x, y [m] and yaw [rad] of the left and right foot (2, 3).
        robots: constants (1,).
    """
    walk, robot = walks[0], robots[0]
    plan, limbs, pendulum = walk.plan, walk.limbs, walk.pendulum
    gait = plan.gait
    for side in range(2):
        foot = Foothold(side == LEFT, stance[side, 0], stance[side, 1], stance[side, 2])
        put(gait.footholds[side], foot)
        rest_at(limbs.feet[side], foot)
    put_timing(gait.clock.timing, cadence(STILL, robot))
    put_timing(walk.steering.timing, cadence(STILL, robot))
    stand(gait, robot)
    remember(walk)
    walk.admission.fraction = 1.0
    plan_walk(plan, foothold(gait.landing), robot.still, False, robot)
    end = plan.ramps[0]
    pendulum.x, pendulum.y = pendulum.zmp_x, pendulum.zmp_y = end.bx, end.by
    restart_cycle(walk.corrections)
    limbs.pelvis.x, limbs.pelvis.y, limbs.pelvis.yaw = pelvis_over(
        limbs.feet, (end.bx, end.by), robot.com_ahead
    )


def measure_body(
    walks: Records[Data], sensors: BodySensors, robot: RobotModel, robots: Records[Model]
) -> bool:
    """Measure the body; return whether the robot is fallen.

    Args:
        walks: state (1,), changed.
        sensors: read in this tick.
        robot: model of the robot.
        robots: constants (1,).
    """
    return measure(
        walks,
        sensors.joint_position,
        sensors.orientation,
        sensors.gyro,
        sensors.foot_force,
        robot.links,
        robot.order,
        robots,
    )


@compiled
def plan_tick(
    walks: Records[Data],
    odometry: Records[DeadReckoning],
    robots: Records[Model],
    parts: Parts,
    angles: Array,
    command: StepValues,
    explicit: bool,
    head: Point,
) -> float:
    """Run a tick up to the motion of the dynamic model, after `measure_body`.

    Args:
        walks: state (1,), changed.
        odometry: dead reckoning (1,), changed.
        robots: constants (1,).
        parts: joints, and motion of the dynamic model; changed.
        angles: planned angles of all joints, set (n,) [rad].
        command: velocity (vx, vy, wz), or an explicit footstep.
        explicit: whether the command is a footstep.
        head: pan and tilt to look at [rad].

    Returns:
        distance of the pendulum from the support foot if the plan diverged, zero otherwise [m].
    """
    walk, robot, plan = walks[0], robots[0], walks[0].plan
    gait = plan.gait
    reckon_body(odometry[0], walk.body, gait.stepping)
    update_error(walk, robot)
    if walk.limbs.moved and is_fallen(walk.body, robot):
        walk.limits = FALLEN if explicit or command[:3] != STILL else 0
        _keep_posture(parts, angles)
        return 0.0
    if gait.stepping and not robot.modifiable:
        follow_body(walk, robot)
    remember(walk)
    limits = follow(walk, command, explicit, robot)
    want_strides(walk, odometry[0], robot)
    limits |= start_walk(walk, robot)
    detect_touchdown(walk, robot)
    region = _contact_region(walk, robot.pattern.sole_margin, robot)
    limits |= place_foot(walk, region, robot)
    advance_pendulum(walk, region, robot)
    distance = _far(walk, robot)
    if distance != 0.0:
        return distance
    _balance(walk, region, robot)
    advance(plan, walk.limbs.feet, robot)
    height = gait.clock.timing.swing_height
    if not is_double(gait) and abs(gait.swing_height - height) > SAME_HEIGHT:
        limits |= SWING_HEIGHT
    end_capture(walk)
    walk.limits = limits
    _move_body(walk, parts.joints, angles, head, robot)
    poses = np.empty((parts.links.size, 12))
    walk.limbs.com_x, walk.limbs.com_y, _ = tree_pass(parts.links, parts.order, angles, poses)
    acceleration = _base_acceleration(walk, robot)
    motion = (parts.q, parts.v, parts.a)
    set_motion(parts.joints, angles, motion, walk.limbs.pelvis.yaw, acceleration, robot)
    return 0.0


@compiled
def set_setpoints(
    walks: Records[Data],
    robots: Records[Model],
    joints: Records[Joint],
    forces: Array,
    gyro: Array,
    angles: Array,
    measured: Array,
    setpoint: Array,
) -> None:
    """Set the setpoints of the servos; a fallen robot is compliant, only damping acts.

    Args:
        walks: state (1,).
        robots: constants (1,).
        joints: joints of the robot (n,), changed.
        forces: generalised forces of the motion without contact, those of the base first.
        gyro: angular velocity of the trunk (3,) [rad/s].
        angles: planned angles of all joints (n,) [rad].
        measured: measured angles of all joints (n,) [rad].
        setpoint: set (n,) [rad].
    """
    walk, robot = walks[0], robots[0]
    if is_fallen(walk.body, robot):
        setpoint[:] = measured
        return
    gait = walk.plan.gait
    left, right = foothold(gait.footholds[LEFT]), foothold(gait.footholds[RIGHT])
    zmps = (zmp_under(left, robot), zmp_under(right, robot))
    set_offsets(joints, walk, forces, gyro, zmps, robot)
    set_within_range(joints, angles, measured, setpoint, robot)


@compiled
def _contact_region(walk: Data, margin: float, robot: Model) -> Region:
    """Return the region of the feet in contact, and remember these feet."""
    gait = walk.plan.gait
    walk.single = not is_double(gait)
    loading = support_foot(gait)
    unloading = loading if walk.single else swing_foot(gait)
    put(walk.loading, loading)
    put(walk.unloading, unloading)
    return support_region(robot.support, unloading, loading, margin)


@compiled
def _far(walk: Data, robot: Model) -> float:
    """Return the distance of the pendulum from the support foot if it is absurd, else zero [m]."""
    foot = walk.plan.gait.footholds[walk.plan.gait.support]
    distance = max(abs(walk.pendulum.x - foot.x), abs(walk.pendulum.y - foot.y))
    return 0.0 if distance < DIVERGED * robot.leg_length else distance


@compiled
def _balance(walk: Data, region: Region, robot: Model) -> None:
    """Share the load, shift the ZMP by the ankles, and measure the margin of the planned ZMP."""
    pendulum, error = walk.pendulum, (walk.error.dcm_x, walk.error.dcm_y)
    x, y = pendulum.zmp_x, pendulum.zmp_y
    walk.limbs.load = _right_load(walk.plan.gait, region, (x, y))
    reachable = _contact_region(walk, robot.stabilizer.sole_margin, robot)
    walk.zmp_shift.x, walk.zmp_shift.y = zmp_shift((x, y), error, reachable, robot)
    corners = polygon(robot.support, foothold(walk.unloading), foothold(walk.loading), walk.single)
    walk.zmp_depth = depth(corners, x, y)


@compiled
def _right_load(gait: Gait, region: Region, zmp: Point) -> float:
    """Return the planned load fraction of the right foot [1]."""
    x, y = zmp
    loading = load_fraction(region, x, y) if is_double(gait) else 1.0
    return loading if gait.support == RIGHT else 1.0 - loading


@compiled
def _move_body(
    walk: Data, joints: Records[Joint], angles: Array, head: Point, robot: Model
) -> None:
    """Move the pelvis with the pendulum, and set the posture."""
    limbs, pendulum = walk.limbs, walk.pendulum
    advance_head(limbs, head, robot)
    head_angles = head_joints(limbs.pan, limbs.tilt, joints, robot)
    before = limbs.pelvis.yaw
    compensate(limbs, walk.plan, robot)
    offset = walk.corrections.com_offset
    dx, dy = rotate(before, offset.x, offset.y)
    com = (pendulum.x + (limbs.offset.x + dx), pendulum.y + (limbs.offset.y + dy))
    set_posture(angles, walk, com, head_angles, joints, robot)
    limbs.turn_rate = (limbs.pelvis.yaw - before) / CONTROL_PERIOD
    if not limbs.moved:
        limbs.moved = True
        for k in range(angles.size):
            joints[k].angle = angles[k]


@compiled
def _keep_posture(parts: Parts, angles: Array) -> None:
    """Keep the posture after a fall: footsteps and head stop."""
    for k in range(angles.size):
        joint = parts.joints[k]
        angles[k], joint.rate, joint.rate_ahead = joint.angle, 0.0, 0.0
        parts.q[joint.in_q] = joint.angle
    parts.v[:] = 0.0
    parts.a[:] = 0.0


@compiled
def _base_acceleration(walk: Data, robot: Model) -> Point:
    """Return the planned acceleration of the base in the plan frame [m/s²]."""
    pendulum, acceleration = walk.pendulum, walk.limbs.offset_acceleration
    w2 = robot.omega * robot.omega
    return (
        w2 * (pendulum.x - pendulum.zmp_x) + acceleration.x,
        w2 * (pendulum.y - pendulum.zmp_y) + acceleration.y,
    )
