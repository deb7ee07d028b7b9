"""Posture of the whole body in a control tick: pelvis, legs, head and arms.

A foot in the air is kept parallel to the floor against the tilt of the trunk. The hips sink where a
leg would be stretched. The arms swing against the legs.
"""

from math import cos, sin, sqrt

from compilation import compiled
from walking.body.kinematics import Pose, solve_leg
from walking.gait import is_airborne, swing_of
from walking.plane import Array, Point, Vector, clamp, rotate_back
from walking.records import Record
from walking.swing import NO_FOOT

MIN_TILT = 1e-6  # smaller tilts of a foot are set to zero [rad]
LEG_JOINTS = 6


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
        target = (x, y, z + sunk, roll, pitch, yaw)
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
        excess = max(0.0, tilt - p.tilt_dead_zone) + min(0.0, tilt + p.tilt_dead_zone)
        levelled: float = own + p.tilt_pull * (p.tilt_gain * excess - own)
        return levelled
    decayed: float = own * p.tilt_decay
    return decayed if abs(decayed) >= MIN_TILT else 0.0


@compiled
def _foot_pose(limbs: Record, side: int, support: Record, pelvis: Vector, height: float) -> Pose:
    """Return the pose of a foot in the base frame, `height` above the floor [m]."""
    foot, roll, pitch = limbs.feet[side], limbs.foot_roll[side], limbs.foot_pitch[side]
    c, s = cos(pelvis[2]), sin(pelvis[2])
    lift = foot.height
    if roll != 0.0 or pitch != 0.0:
        ax, ay = foot.x - support.x, foot.y - support.y
        lift += pitch * (c * ax + s * ay) - roll * (c * ay - s * ax)
    dx, dy, turned = foot.x - pelvis[0], foot.y - pelvis[1], foot.yaw - pelvis[2]
    cf, sf = cos(turned), sin(turned)
    return (
        c * dx + s * dy,
        c * dy - s * dx,
        lift - height,
        -(cf * roll + sf * pitch),
        -(cf * pitch - sf * roll),
        turned,
    )


@compiled
def sink(foot: Pose, reach: Array) -> float:
    """Return how far the base must sink for a leg to reach a foot [m].

    Args:
        foot: pose in the base frame.
        reach: hip in the base frame (3) [m], ankle in the frame of the foot (3) [m], maximum
            distance between them [m] (7,).
    """
    c, s = cos(foot[5]), sin(foot[5])
    dx = foot[0] + c * reach[3] - s * reach[4] - reach[0]
    dy = foot[1] + s * reach[3] + c * reach[4] - reach[1]
    down = reach[2] - foot[2] - reach[5]
    sunk: float = max(0.0, down - sqrt(max(0.0, reach[6] * reach[6] - dx * dx - dy * dy)))
    return sunk
