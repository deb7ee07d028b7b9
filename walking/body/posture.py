"""Posture of the whole body in a control tick: pelvis, legs, head and arms.

A foot in the air is kept parallel to the floor against the tilt of the trunk. The hips sink where a
leg would be stretched. The arms swing against the legs.
"""

from math import asin, atan2, cos, sin, sqrt

from compilation import compiled
from compilation.record import Records
from walking.body.kinematics import FootPose, solve_leg
from walking.data import Data, FootReference, Limbs
from walking.model import LEFT, RIGHT, HeadAxis, Joint, LegReach, Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.gait import is_airborne, swing_of
from walking.plane import Array, Point, Vector, clamp, dead_zone, from_frame, rotate_back, within

MIN_TILT = 1e-6  # smaller tilts of a foot are set to zero [rad]
LEG_JOINTS = 6
NO_FOOT = -1


@compiled
def pelvis_over(feet: Records[FootReference], com: Point, ahead: float) -> Vector:
    """Return the pelvis x, y [m], heading [rad] for a centre of mass `ahead` of it at `com` [m].

    Its heading is between those of the feet.
    """
    (x, y), yaw = com, 0.5 * (feet[LEFT].yaw + feet[RIGHT].yaw)
    return x - ahead * cos(yaw), y - ahead * sin(yaw), yaw


@compiled
def set_posture(
    angles: Array,
    walk: Data,
    com: Point,
    head: Point,
    joints: Records[Joint],
    robot: Model,
) -> None:
    """Set the planned angles of all joints, and the pelvis.

    Args:
        angles: set (n,) [rad].
        walk: state; pelvis, tilts of the feet and solution of the legs are changed.
        com: planned centre of mass in the plan frame, x, y [m].
        head: angles of pan and tilt joint [rad].
        joints: joints of the robot (n,).
        robot: constants.
    """
    limbs, gait, neck = walk.limbs, walk.plan.gait, robot.neck
    for k in range(angles.size):
        angles[k] = joints[k].ready
    pelvis = pelvis_over(limbs.feet, com, robot.com_ahead)
    limbs.pelvis.x, limbs.pelvis.y, limbs.pelvis.yaw = pelvis
    airborne = swing_of(gait) if is_airborne(gait) else NO_FOOT
    level_feet(limbs, airborne, (walk.body.roll, walk.body.pitch), robot)
    support = limbs.feet[gait.support]
    left = _foot_pose(limbs, LEFT, support, pelvis, robot.height)
    right = _foot_pose(limbs, RIGHT, support, pelvis, robot.height)
    sunk = max(sink(left, robot.reach[LEFT]), sink(right, robot.reach[RIGHT]))
    limbs.leg_error = 0.0
    for side in range(2):
        x, y, z, roll, pitch, yaw = right if side == RIGHT else left
        target = FootPose(x, y, z + sunk, roll, pitch, yaw)
        first = LEG_JOINTS * side
        own = limbs.leg_angles[first : first + LEG_JOINTS]
        axes, origins = limbs.axes[side], limbs.origins[side]
        _, error = solve_leg(robot.chains[side], target, own, robot.leg_length, axes, origins)
        limbs.leg_error = max(limbs.leg_error, error)
        for k in range(LEG_JOINTS):
            joint = joints[first + k]
            angles[first + k] = within(own[k], joint.lower, joint.upper)
    if neck.movable:
        angles[neck.pan.joint], angles[neck.tilt.joint] = head
    if robot.shoulders[LEFT].joint >= 0:
        _swing_arms(angles, limbs.feet, limbs.pelvis.yaw, robot)


@compiled
def advance_head(limbs: Limbs, target: Point, robot: Model) -> None:
    """Run one tick: time-optimal approach to the target on each axis, without overshoot.

    Args:
        limbs: pan and tilt and their rates, changed.
        target: pan and tilt [rad].
        robot: constants.
    """
    neck, (pan, tilt) = robot.neck, target
    limbs.pan, limbs.pan_rate = _approach(limbs.pan, limbs.pan_rate, pan, neck.pan, robot)
    limbs.tilt, limbs.tilt_rate = _approach(limbs.tilt, limbs.tilt_rate, tilt, neck.tilt, robot)


@compiled
def _approach(angle: float, rate: float, target: float, axis: HeadAxis, robot: Model) -> Point:
    """Return angle [rad] and rate [rad/s] of an axis a tick later."""
    p = robot.head
    step = p.max_acceleration * CONTROL_PERIOD
    error = within(target, axis.lower, axis.upper) - angle
    # Maximum speed from which whole ticks of braking end at the target.
    reach = step * (sqrt(0.25 + 2.0 * abs(error) / (step * CONTROL_PERIOD)) - 0.5)
    wanted = min(p.max_rate, reach, abs(error) / CONTROL_PERIOD)
    wanted = wanted if error >= 0.0 else -wanted
    rate += clamp(wanted - rate, step)
    return angle + rate * CONTROL_PERIOD, rate


@compiled
def head_joints(pan: float, tilt: float, joints: Records[Joint], robot: Model) -> Point:
    """Return the angles of pan and tilt joint, within their range, for pan and tilt [rad]."""
    neck = robot.neck
    if not neck.movable:
        return 0.0, 0.0
    if neck.tilt_first:
        # The pan joint turns about a tilted axis: it alone moves the optical axis sideways.
        flat = cos(neck.tilt.rest)
        side = asin(clamp(cos(tilt) * sin(pan) / flat, 1.0))
        raised = atan2(sin(tilt), cos(tilt) * cos(pan))
        bent = atan2(sin(neck.tilt.rest), flat * cos(side))
        pan, tilt = side, raised - bent + neck.tilt.rest
    return _head_joint(pan, neck.pan, joints), _head_joint(tilt, neck.tilt, joints)


@compiled
def _head_joint(angle: float, axis: HeadAxis, joints: Records[Joint]) -> float:
    """Return the angle of the joint of an axis within its range [rad]."""
    joint = joints[axis.joint]
    return within(axis.sign * (angle - axis.rest), joint.lower, joint.upper)


@compiled
def _swing_arms(angles: Array, feet: Records[FootReference], yaw: float, robot: Model) -> None:
    arms, left, right = robot.arms, robot.shoulders[LEFT], robot.shoulders[RIGHT]
    one, other = feet[LEFT], feet[RIGHT]
    apart, _ = rotate_back(yaw, one.x - other.x, one.y - other.y)
    # Counter-swing, backward positive on the side of the foot ahead.
    swing = clamp(arms.swing_gain * apart, arms.max_swing)
    angles[left.joint] += left.sign * swing
    angles[right.joint] -= right.sign * swing


@compiled
def level_feet(limbs: Limbs, airborne: int, tilt: Point, robot: Model) -> None:
    """Update the tilts of the feet: of the foot in the air against that of the trunk.

    Args:
        limbs: tilts are changed.
        airborne: index of the foot in the air, -1 for none.
        tilt: roll and pitch of the trunk [rad].
        robot: constants.
    """
    roll, pitch = tilt
    for side in range(2):
        in_air = side == airborne
        limbs.foot_roll[side] = _levelled(limbs.foot_roll[side], in_air, roll, robot)
        limbs.foot_pitch[side] = _levelled(limbs.foot_pitch[side], in_air, pitch, robot)


@compiled
def _levelled(own: float, in_air: bool, tilt: float, robot: Model) -> float:
    p = robot.stabilizer
    if in_air:
        wanted = p.tilt_gain * dead_zone(tilt, p.tilt_dead_zone)
        return own + p.tilt_pull * (wanted - own)
    decayed = own * p.tilt_decay
    return decayed if abs(decayed) >= MIN_TILT else 0.0


@compiled
def _foot_pose(
    limbs: Limbs, side: int, support: FootReference, pelvis: Vector, height: float
) -> FootPose:
    """Return the pose of a foot in the base frame, `height` above the floor [m]."""
    foot, roll, pitch = limbs.feet[side], limbs.foot_roll[side], limbs.foot_pitch[side]
    (px, py, yaw), lift = pelvis, foot.height
    if roll != 0.0 or pitch != 0.0:
        ahead, left = rotate_back(yaw, foot.x - support.x, foot.y - support.y)
        lift += pitch * ahead - roll * left
    x, y = rotate_back(yaw, foot.x - px, foot.y - py)
    relative = foot.yaw - yaw
    own_roll, own_pitch = rotate_back(relative, roll, pitch)
    return FootPose(x, y, lift - height, -own_roll, -own_pitch, relative)


@compiled
def sink(foot: FootPose, reach: LegReach) -> float:
    """Return how far the base must sink for a leg to reach a foot [m].

    Args:
        foot: pose in the base frame.
        reach: reach of the leg.
    """
    x, y = from_frame((foot.x, foot.y, foot.yaw), reach.ankle_x, reach.ankle_y)
    dx, dy, down = x - reach.hip_x, y - reach.hip_y, reach.hip_z - foot.z - reach.ankle_z
    length = reach.length
    return max(0.0, down - sqrt(max(0.0, length * length - dx * dx - dy * dy)))
