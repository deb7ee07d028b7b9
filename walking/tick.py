"""Control tick of the walk: three compiled functions and inverse dynamics.

`walking.estimation.watch` measures the body; `begin` estimates, decides, plans, and sets the
posture and its rates; after inverse dynamics `finish` adds the feed-forward.
"""

import numpy as np

from compilation import compiled
from compilation.record import record_type
from walking.admission import ADMISSION, remember
from walking.balance import (
    PLACING,
    advance_pendulum,
    end_capture,
    exceeds,
    follow_body,
    place_foot,
    zmp_shift,
)
from walking.body.kinematics import tree_pass
from walking.command import BALANCE, FALLEN, SWING_HEIGHT, TIMING
from walking.corrections import (
    CORRECTIONS,
    correct_offset,
    cycle_begins,
    detects_touchdown,
    discard_offset_cycle,
    heading_rate,
    reset_speed,
    restart_cycle,
    speed_correction,
    speed_ratio,
)
from walking.estimation import SENSING, estimate, is_fallen
from walking.feedforward import set_motion, set_offsets, set_setpoints
from walking.footsteps import FOOTHOLD, STILL, Command, Foothold, foothold, put, tendency
from walking.gait import (
    advance,
    end_support,
    retime,
    stand,
    start,
    support_foot,
    swing_foot,
    swing_of,
    touch_down,
    zmp_under,
)
from walking.parameters import CONTROL_PERIOD
from walking.pendulum import PENDULUM
from walking.plane import Array, Indices, Point, norm, rotate, rotate_back
from walking.posture import LIMBS, advance_head, head_joints, pelvis_over, set_posture
from walking.records import Record
from walking.reference import LIVE, plan_walk
from walking.steering import (
    STEERING,
    follow_command,
    moves,
    set_wanted_strides,
    use_next_timing,
    wanted_velocity,
)
from walking.support import Region, depth, load_fraction, polygon, support_region
from walking.swing import rest_at
from walking.swing_reaction import compensate
from walking.timing import cadence, put_timing

WALK = record_type(
    ticks=int,
    sensing=SENSING,
    steering=STEERING,
    corrections=CORRECTIONS,
    admission=ADMISSION,
    placing=PLACING,
    pendulum=PENDULUM,
    planned=PENDULUM,
    off_plan=bool,
    zmp_shift_x=float,
    zmp_shift_y=float,
    zmp_depth=float,
    single=bool,
    unloading=FOOTHOLD,
    loading=FOOTHOLD,
    last_opening_left=bool,
    bound=int,
    limbs=LIMBS,
)
"""State of the walk: ticks; the parts above; pendulum of the body, and that of the plan if it
differs; shift of the ZMP by the ankles [m]; depth of the planned ZMP in the support polygon [m],
whether one foot supports, and the feet in contact; foot of the last opening step; limits that bind,
as bits."""

SAME_HEIGHT = 1e-9  # rounding error of swing heights [m]
DIVERGED = 1e6  # distance of the pendulum from the support foot per length of the leg [1]


@compiled
def stand_ready(
    walks: Record,
    plans: Record,
    stance: Array,
    robots: Record,
) -> None:
    """Set the state of a robot that stands in the ready posture.

    Args:
        walks: state (1,), changed.
        plans: plans (4,), changed.
        stance: x, y [m] and yaw [rad] of the left and right foot (2, 3).
        robots: constants (1,).
    """
    walk, robot, live = walks[0], robots[0], plans[LIVE]
    gait, limbs, pendulum = live.gait, walk.limbs, walk.pendulum
    for side in range(2):
        foot = Foothold(side == 0, stance[side, 0], stance[side, 1], stance[side, 2])
        put(gait.footholds[side], foot)
        rest_at(limbs.feet[side], foot)
    put_timing(gait.clock.timing, cadence(STILL, robot))
    put_timing(walk.steering.timing, cadence(STILL, robot))
    stand(gait, robot)
    remember(walk.admission, gait)
    walk.admission.fraction = 1.0
    plan_walk(live, foothold(gait.landing), robot.still, False, robot)
    end = live.ramps[0]
    pendulum.x, pendulum.y = pendulum.zmp_x, pendulum.zmp_y = end.bx, end.by
    restart_cycle(walk.corrections)
    limbs.pelvis[0], limbs.pelvis[1], limbs.pelvis[2] = pelvis_over(
        limbs.feet, (end.bx, end.by), robot.com_ahead
    )


@compiled
def begin(
    walks: Record,
    odometry: Record,
    plans: Record,
    knots: Record,
    joints: Record,
    robots: Record,
    sums: Record,
    links: Array,
    order: Indices,
    q: Array,
    v: Array,
    a: Array,
    angles: Array,
    gyro: Array,
    command: Command,
    explicit: bool,
    head: Point,
) -> tuple[float, float, int]:
    """Run a tick up to the motion of the dynamic model, after `watch`.

    Args:
        walks: state (1,), changed.
        odometry: dead reckoning (1,), changed.
        plans: plans (4,), changed.
        knots: knots of the plans (4, k), changed.
        joints: joints of the robot (n,), changed.
        robots: constants (1,).
        sums: sums of the gains of preview control.
        links: links of the robot, see `walking.body.kinematics.tree_pass`.
        order: order of its joints.
        q: position of the dynamic model, set.
        v: velocity of the dynamic model, set.
        a: acceleration of the dynamic model, set.
        angles: planned angles of all joints, set (n,) [rad].
        gyro: angular velocity of the trunk (3,) [rad/s].
        command: velocity (vx, vy, wz), or a command state if `explicit`.
        explicit: whether the command is a command state.
        head: pan and tilt to look at [rad].

    Returns:
        distance of the pendulum from the support foot if the plan diverged, zero otherwise [m];
        depth of the planned ZMP in the support polygon [m]; limits that bind, as bits.
    """
    walk, robot = walks[0], robots[0]
    live, pendulum = plans[LIVE], walk.pendulum
    gait = live.gait
    estimate(walk, odometry[0], gait.right_weight, gait.stepping, robot)
    settled = walk.ticks * CONTROL_PERIOD > robot.gait.settle_time
    if gait.stepping:
        follow_body(walk, support_foot(gait), robot)
    remember(walk.admission, gait)
    _follow(walk, gait, command, explicit, settled, robot)
    _want_strides(walk, gait, odometry[0], robot)
    if not gait.stepping and settled:
        _maybe_start(walk, gait, robot)
    _detect_touchdown(walk, gait, robot)
    region = _contact_region(walk, gait, robot.pattern.sole_margin, robot)
    place_foot(walk, plans, knots, region, robot)
    advance_pendulum(walk, plans, knots, region, robot, sums)
    distance = _far(walk, gait, robot)
    if distance != 0.0:
        return distance, walk.zmp_depth, 0
    zmp, error = (pendulum.zmp_x, pendulum.zmp_y), (walk.sensing.dcm_x, walk.sensing.dcm_y)
    walk.limbs.load = _right_load(gait, region, zmp)
    reachable = _contact_region(walk, gait, robot.stabilizer.sole_margin, robot)
    walk.zmp_shift_x, walk.zmp_shift_y = zmp_shift(zmp, error, reachable, robot)
    corners = polygon(robot.support, foothold(walk.unloading), foothold(walk.loading), walk.single)
    walk.zmp_depth = depth(corners, zmp[0], zmp[1])
    advance(live, walk.limbs.feet, robot)
    height = gait.clock.timing.swing_height
    if not gait.double and abs(gait.swing_height - height) > SAME_HEIGHT:
        walk.bound |= SWING_HEIGHT
    end_capture(walk, live)
    _move_body(walk, live, joints, angles, head, robot)
    poses = np.empty((links.shape[0], 12))
    walk.limbs.com[0], walk.limbs.com[1], _ = tree_pass(links, order, angles, poses)
    acceleration = walk.limbs.offset_acceleration
    w2 = robot.omega * robot.omega
    moved = (
        w2 * (pendulum.x - zmp[0]) + acceleration[0],
        w2 * (pendulum.y - zmp[1]) + acceleration[1],
    )
    set_motion(joints, angles, q, v, a, walk.limbs.pelvis[2], moved, robot)
    return 0.0, walk.zmp_depth, walk.bound | walk.steering.bound | walk.placing.bound


@compiled
def finish(
    walks: Record,
    plans: Record,
    joints: Record,
    robots: Record,
    forces: Array,
    gyro: Array,
    angles: Array,
    measured: Array,
    setpoint: Array,
) -> None:
    """Set the setpoints of the servos.

    Args:
        walks: state (1,), changed.
        plans: plans (4,).
        joints: joints of the robot (n,), changed.
        robots: constants (1,).
        forces: generalised forces of the motion without contact, those of the base first.
        gyro: angular velocity of the trunk (3,) [rad/s].
        angles: planned angles of all joints (n,) [rad].
        measured: measured angles of all joints (n,) [rad].
        setpoint: set (n,) [rad].
    """
    walk, robot = walks[0], robots[0]
    gait = plans[LIVE].gait
    left, right = foothold(gait.footholds[0]), foothold(gait.footholds[1])
    zmps = (zmp_under(left, robot), zmp_under(right, robot))
    set_offsets(joints, walk, forces, gyro, zmps, robot)
    set_setpoints(joints, angles, measured, setpoint, robot)


@compiled
def _follow(
    walk: Record,
    gait: Record,
    command: Command,
    explicit: bool,
    settled: bool,
    robot: Record,
) -> None:
    """Follow the command; give the footsteps their timing."""
    steering, sensing, timing = walk.steering, walk.sensing, walk.admission.between
    steering.command.explicit = explicit
    for k in range(6):
        steering.command.values[k] = command[k]
    off = norm(sensing.dcm_x, sensing.dcm_y)
    balanced = off < robot.stabilizer.max_slew_error
    ratio = speed_ratio(walk.corrections, off, robot)
    follow_command(steering, ratio, settled, balanced, robot)
    use_next_timing(timing, steering, gait.clock.timing, gait.stepping)
    walk.bound = 0 if retime(gait, timing, robot) else TIMING


@compiled
def _want_strides(walk: Record, gait: Record, odometry: Record, robot: Record) -> None:
    """Set the wanted strides, corrected for slip of the feet."""
    corrections, steering, sensing = walk.corrections, walk.steering, walk.sensing
    ahead = walk.limbs.pelvis[2] - odometry.yaw
    if not gait.stepping:
        # While standing the planned heading follows the measured one.
        corrections.held = ahead
        restart_cycle(corrections)
    if not (gait.stepping and moves(steering)):
        # The last footsteps only close the stance.
        reset_speed(corrections)
        discard_offset_cycle(corrections)
        set_wanted_strides(steering, STILL, robot)
        return
    begins = cycle_begins(corrections, gait.support)
    shift = norm(walk.placing.moved_x, walk.placing.moved_y)
    disturbed = gait.shortened or shift > robot.stabilizer.max_steady_shift
    pressure = (sensing.pressure_x, sensing.pressure_y)
    correct_offset(corrections, pressure, begins, disturbed, robot)
    pose, velocity = (odometry.x, odometry.y, odometry.yaw), wanted_velocity(steering)
    vx, vy = speed_correction(corrections, pose, velocity, begins, disturbed, robot)
    wz = heading_rate(corrections, ahead, begins or disturbed, robot)
    set_wanted_strides(steering, (vx, vy, wz), robot)


@compiled
def _maybe_start(walk: Record, gait: Record, robot: Record) -> None:
    """Take a first footstep if the command or balance requires it."""
    foot, moving = foothold(gait.footholds[0]), moves(walk.steering)
    error = (walk.sensing.dcm_x, walk.sensing.dcm_y)
    ratio = robot.stabilizer.step_error_ratio
    pushed, fallen = exceeds(foot, error, ratio, robot), is_fallen(walk.sensing, robot)
    if fallen and moving:
        walk.bound |= FALLEN
    if fallen or not (moving or pushed):
        return
    sideways = tendency(wanted_velocity(walk.steering), robot)
    opening_left = sideways > 0.0
    if pushed:
        # Only the foot on the side of the fall can make the capture step.
        if not moving:
            walk.bound |= BALANCE
        opening_left = rotate_back(foot.yaw, error[0], error[1])[1] > 0.0
    elif sideways == 0.0:
        opening_left = not walk.last_opening_left
    walk.last_opening_left = opening_left
    start(gait, 1 if opening_left else 0, pushed, robot)
    if not retime(gait, walk.steering.timing, robot):
        walk.bound |= TIMING


@compiled
def _detect_touchdown(walk: Record, gait: Record, robot: Record) -> None:
    """Stop the swing foot on early touchdown; off balance, go on with the next footstep.

    A support that waited for its planned end would let the error of the DCM grow over one foot
    while both are on the floor.
    """
    if gait.stepping and not gait.double and not gait.landed_early:
        phase, force = gait.swing_phase, walk.sensing.feet[swing_of(gait)].load
        if detects_touchdown(walk.corrections, phase, force, robot) and phase < 1.0:
            touch_down(gait, walk.limbs.feet, robot)
            error, ratio = (walk.sensing.dcm_x, walk.sensing.dcm_y), robot.stabilizer.capture_dead_zone
            if gait.shortened or exceeds(support_foot(gait), error, ratio, robot):
                end_support(gait, robot)


@compiled
def _contact_region(walk: Record, gait: Record, margin: float, robot: Record) -> Region:
    """Return the region of the feet in contact, and remember these feet."""
    walk.single = not gait.double
    loading = support_foot(gait)
    unloading = swing_foot(gait) if gait.double else loading
    put(walk.loading, loading)
    put(walk.unloading, unloading)
    return support_region(robot.support, unloading, loading, margin)


@compiled
def _far(walk: Record, gait: Record, robot: Record) -> float:
    """Return the distance of the pendulum from the support foot if it is absurd, else zero [m]."""
    foot = gait.footholds[gait.support]
    distance = max(abs(walk.pendulum.x - foot.x), abs(walk.pendulum.y - foot.y))
    return 0.0 if distance < DIVERGED * robot.leg_length else distance


@compiled
def _right_load(gait: Record, region: Region, zmp: Point) -> float:
    """Return the planned load fraction of the right foot [1]."""
    loading = load_fraction(region, zmp[0], zmp[1]) if gait.double else 1.0
    return loading if gait.support == 1 else 1.0 - loading


@compiled
def _move_body(
    walk: Record,
    live: Record,
    joints: Record,
    angles: Array,
    head: Point,
    robot: Record,
) -> None:
    """Move the pelvis with the pendulum, and set the posture."""
    limbs, pendulum = walk.limbs, walk.pendulum
    advance_head(limbs, head, robot)
    turned = head_joints(limbs.head[0], limbs.head[1], joints, robot)
    before = limbs.pelvis[2]
    compensate(limbs, live, robot)
    offset = walk.corrections.com_offset
    dx, dy = rotate(before, offset[0], offset[1])
    com = (pendulum.x + (limbs.offset[0] + dx), pendulum.y + (limbs.offset[1] + dy))
    set_posture(angles, walk, live.gait, com, turned, joints, robot)
    limbs.turn_rate = (limbs.pelvis[2] - before) / CONTROL_PERIOD
    if not limbs.moved:
        limbs.moved = True
        for k in range(angles.size):
            joints[k].angle = angles[k]
