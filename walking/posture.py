"""Posture of the whole body in a control tick: pelvis, legs, head and arms.

A foot in the air is kept parallel to the floor against the tilt of the trunk. The hips sink where a
leg would be stretched. The arms swing against the legs.
"""

from math import asin, atan2, cos, sin, sqrt

from compilation import compiled
from compilation.record import record_type
from walking.body.kinematics import FootPose, solve_leg
from walking.gait import is_airborne, swing_of
from walking.parameters import CONTROL_PERIOD
from walking.plane import Array, Point, Vector, clamp, dead_zone, from_frame, rotate_back
from walking.records import Record
from walking.swing import REFERENCE

LIMBS = record_type(
    moved=bool,
    feet=(REFERENCE, 2),
    pelvis=(float, 3),
    turn_rate=float,
    com=(float, 2),
    # Compensation of the swing leg, see `walking.swing_reaction`.
    offset=(float, 2),
    ahead=(float, 2),
    offset_acceleration=(float, 2),
    # Tilt of the feet against that of the trunk, roll and pitch of each [rad].
    foot_roll=(float, 2),
    foot_pitch=(float, 2),
    leg_angles=(float, 12),
    axes=(float, 2, 6, 3),
    origins=(float, 2, 6, 3),
    leg_error=float,
    head=(float, 2),
    head_rate=(float, 2),
    load=float,
)
"""Whether there is a posture before this tick; references of the feet; pelvis x, y [m], heading
[rad] in the plan frame, and its yaw rate [rad/s]; centre of mass of the last posture in the base
frame [m]; angles of the legs, also beyond their limits [rad], axes and origins of their joints in
the base frame [m], and remaining error of the inverse kinematics [rad]; pan and tilt [rad] and
their rates [rad/s]; load fraction of the right foot in this tick [1]."""

MIN_TILT = 1e-6  # smaller tilts of a foot are set to zero [rad]
LEG_JOINTS = 6
NO_FOOT = -1


@compiled
def pelvis_over(feet: Record, com: Point, ahead: float) -> Vector:
    """Return the pelvis x, y [m], heading [rad] for a centre of mass `ahead` of it at `com` [m].

    Its heading is between those of the feet.
    """
    yaw = 0.5 * (feet[0].yaw + feet[1].yaw)
    return com[0] - ahead * cos(yaw), com[1] - ahead * sin(yaw), yaw


@compiled
def set_posture(
    angles: Array,
    walk: Record,
    gait: Record,
    com: Point,
    head: Point,
    joints: Record,
    robot: Record,
) -> None:
    """Set the planned angles of all joints, and the pelvis.

    Args:
        angles: set (n,) [rad].
        walk: state; pelvis, tilts of the feet and solution of the legs are changed.
        gait: gait in force.
        com: planned centre of mass in the plan frame, x, y [m].
        head: angles of pan and tilt joint [rad].
        joints: joints of the robot (n,).
        robot: constants.
    """
    limbs, neck = walk.limbs, robot.neck
    for k in range(angles.size):
        angles[k] = joints[k].ready
    pelvis = pelvis_over(limbs.feet, com, robot.com_ahead)
    for k in range(3):
        limbs.pelvis[k] = pelvis[k]
    airborne = swing_of(gait) if is_airborne(gait) else NO_FOOT
    level_feet(limbs, airborne, (walk.sensing.roll, walk.sensing.pitch), robot)
    support = limbs.feet[gait.support]
    left = _foot_pose(limbs, 0, support, pelvis, robot.height)
    right = _foot_pose(limbs, 1, support, pelvis, robot.height)
    sunk = max(sink(left, robot.reach[0]), sink(right, robot.reach[1]))
    limbs.leg_error = 0.0
    for side in range(2):
        x, y, z, roll, pitch, yaw = right if side == 1 else left
        target = FootPose(x, y, z + sunk, roll, pitch, yaw)
        first = LEG_JOINTS * side
        own = limbs.leg_angles[first : first + LEG_JOINTS]
        axes, origins = limbs.axes[side], limbs.origins[side]
        _, error = solve_leg(robot.chains[side], target, own, robot.leg_length, axes, origins)
        limbs.leg_error = max(limbs.leg_error, error)
        for k in range(LEG_JOINTS):
            joint = joints[first + k]
            angles[first + k] = min(joint.upper, max(joint.lower, own[k]))
    if neck.movable:
        angles[neck.pan_joint], angles[neck.tilt_joint] = head
    if robot.shoulders[0] >= 0:
        _swing_arms(angles, limbs.feet, pelvis[2], robot)


@compiled
def advance_head(limbs: Record, target: Point, robot: Record) -> None:
    """Run one tick: time-optimal approach to the target on each axis, without overshoot.

    Args:
        limbs: pan and tilt and their rates, changed.
        target: pan and tilt [rad].
        robot: constants.
    """
    p, neck = robot.head, robot.neck
    step = p.max_acceleration * CONTROL_PERIOD
    for axis in range(2):
        goal = min(neck.upper[axis], max(neck.lower[axis], target[axis]))
        error = goal - limbs.head[axis]
        # Maximum speed from which whole ticks of braking end at the target.
        reach = step * (sqrt(0.25 + 2.0 * abs(error) / (step * CONTROL_PERIOD)) - 0.5)
        wanted = min(p.max_rate, reach, abs(error) / CONTROL_PERIOD)
        wanted = wanted if error >= 0.0 else -wanted
        limbs.head_rate[axis] += min(step, max(-step, wanted - limbs.head_rate[axis]))
        limbs.head[axis] += limbs.head_rate[axis] * CONTROL_PERIOD


@compiled
def head_joints(pan: float, tilt: float, joints: Record, robot: Record) -> Point:
    """Return the angles of pan and tilt joint, within their range, for pan and tilt [rad]."""
    neck = robot.neck
    if not neck.movable:
        return 0.0, 0.0
    if neck.tilt_first:
        # The pan joint turns about a tilted axis: it alone moves the optical axis sideways.
        flat = cos(neck.rest_tilt)
        side = asin(min(1.0, max(-1.0, cos(tilt) * sin(pan) / flat)))
        raised = atan2(sin(tilt), cos(tilt) * cos(pan))
        bent = atan2(sin(neck.rest_tilt), flat * cos(side))
        pan, tilt = side, raised - bent + neck.rest_tilt
    first, second = joints[neck.pan_joint], joints[neck.tilt_joint]
    return (
        min(first.upper, max(first.lower, neck.pan_sign * (pan - neck.rest_pan))),
        min(second.upper, max(second.lower, neck.tilt_sign * (tilt - neck.rest_tilt))),
    )


@compiled
def _swing_arms(angles: Array, feet: Record, yaw: float, robot: Record) -> None:
    arms, signs = robot.arms, robot.shoulder_signs
    apart, _ = rotate_back(yaw, feet[0].x - feet[1].x, feet[0].y - feet[1].y)
    # Counter-swing, backward positive on the side of the foot ahead.
    swing = clamp(arms.swing_gain * apart, arms.max_swing)
    angles[robot.shoulders[0]] += signs[0] * swing
    angles[robot.shoulders[1]] -= signs[1] * swing


@compiled
def level_feet(limbs: Record, airborne: int, tilt: Point, robot: Record) -> None:
    """Update the tilts of the feet: of the foot in the air against that of the trunk.

    Args:
        limbs: tilts are changed.
        airborne: index of the foot in the air, -1 for none.
        tilt: roll and pitch of the trunk [rad].
        robot: constants.
    """
    for side in range(2):
        in_air = side == airborne
        limbs.foot_roll[side] = _levelled(limbs.foot_roll[side], in_air, tilt[0], robot)
        limbs.foot_pitch[side] = _levelled(limbs.foot_pitch[side], in_air, tilt[1], robot)


@compiled
def _levelled(own: float, in_air: bool, tilt: float, robot: Record) -> float:
    p = robot.stabilizer
    if in_air:
        wanted = p.tilt_gain * dead_zone(tilt, p.tilt_dead_zone)
        levelled: float = own + p.tilt_pull * (wanted - own)
        return levelled
    decayed: float = own * p.tilt_decay
    return decayed if abs(decayed) >= MIN_TILT else 0.0


@compiled
def _foot_pose(
    limbs: Record, side: int, support: Record, pelvis: Vector, height: float
) -> FootPose:
    """Return the pose of a foot in the base frame, `height` above the floor [m]."""
    foot, roll, pitch = limbs.feet[side], limbs.foot_roll[side], limbs.foot_pitch[side]
    yaw, lift = pelvis[2], foot.height
    if roll != 0.0 or pitch != 0.0:
        ahead, left = rotate_back(yaw, foot.x - support.x, foot.y - support.y)
        lift += pitch * ahead - roll * left
    x, y = rotate_back(yaw, foot.x - pelvis[0], foot.y - pelvis[1])
    turned = foot.yaw - yaw
    own_roll, own_pitch = rotate_back(turned, roll, pitch)
    return FootPose(x, y, lift - height, -own_roll, -own_pitch, turned)


@compiled
def sink(foot: FootPose, reach: Array) -> float:
    """Return how far the base must sink for a leg to reach a foot [m].

    Args:
        foot: pose in the base frame.
        reach: hip in the base frame (3) [m], ankle in the frame of the foot (3) [m], maximum
            distance between them [m] (7,).
    """
    x, y = from_frame((foot.x, foot.y, foot.yaw), reach[3], reach[4])
    dx, dy, down = x - reach[0], y - reach[1], reach[2] - foot.z - reach[5]
    sunk: float = max(0.0, down - sqrt(max(0.0, reach[6] * reach[6] - dx * dx - dy * dy)))
    return sunk
