"""What the sensors say of the body in every control tick, compiled.

What is remembered from tick to tick is kept in arrays, booleans as 0 or 1:

    tilt (3,)       whether it is known | roll, pitch [rad];
    odometry (20,)  x, y [m], heading without jumps [rad] | whether the IMU has told one, and which
                    [rad] | whether the vectors from foot to body are known, and which in the
                    odometry frame: left x, y, right x, y [m] | index of the foot that counts |
                    whether both feet carry, and how far apart they were when they began to,
                    x, y [m] |
                    xx, xy, xw, yy, yw, ww of the error's covariance;
    error (5,)      x, y [m], vx, vy [m/s] | weight on the right foot [1], -1 before the first.

Numbers that stay are arrays as well: a tuple is taken apart at every call. The legs' forward
kinematics stands here and not beside its inverse in `leg_kernel`, because no kernel calls one of
another file.
"""

from math import asin, atan2, cos, hypot, pi, sin, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

from walking.body.leg_kernel import Angles, Leg, Point, Pose, Vector

Array = NDArray[np.float64]

Plan = tuple[float, float, float, float, float, float, float, float, float, float, float]
"""Pelvis x, y [m], heading [rad]; mass centre in the base frame x, y; ZMP x, y; by how much the
ankles moved it x, y [m]; turn rate [rad/s]; weight on the right foot [1]."""

RELEASED = 0.2  # share of the weight under which a foot no longer counts
FOUND, LOAD = 24, 10  # numbers found in a tick; the first foot's load among them


@njit(cache=True)
def estimate(
    joints: Array,
    pads: Array,
    orientation: Array,
    gyro: Array,
    com: Array,
    tilt: Array,
    odometry: Array,
    error: Array,
    legs: Array,
    body: Array,
    growth: Array,
    gains: Array,
    feet: Array,
    plan: Plan,
    stepping: bool,
    period: float,
    found: Array,
) -> tuple[Point, Point, Point, Vector]:
    """One tick: `observe`, odometry, and what the body does against the plan.

    Args:
        joints: see `observe`.
        pads: see `observe`.
        orientation: see `observe`.
        gyro: see `observe`.
        com: see `observe`.
        tilt: brought up to date.
        odometry: brought up to date.
        error: brought up to date.
        legs: see `observe`.
        body: see `observe`.
        growth: see `reckon`.
        gains: see `filter_error`.
        feet: their references, see `walking.gait.swing_foot_kernel` (2, 10).
        plan: of the tick before.
        stepping: whether the feet leave the floor.
        period: of control [s].
        found: see `observe`.

    Returns:
        roll and pitch [rad]; error of the DCM in the plan frame [m]; of the centre of pressure,
        forward and left, zero in the air [m]; pose by odometry [m, m, rad].
    """
    inclined = observe(joints, pads, orientation, gyro, com, tilt, legs, body, period, found)
    left, right = (found[6], found[7]), (found[11], found[12])
    reckon(odometry, found[2], (left, right), found[19], stepping, growth)
    yaw, weight = plan[2], plan[10]
    c, s = cos(yaw), sin(yaw)
    planned = (plan[0] + c * plan[3] - s * plan[4], plan[1] + s * plan[3] + c * plan[4])
    measured = (found[16], found[17])
    lx, ly, lax, lay = com_error(measured, (left[0], left[1], found[9]), feet[0], planned)
    rx, ry, rax, ray = com_error(measured, (right[0], right[1], found[14]), feet[1], planned)
    rest, before = 1.0 - weight, error[4]
    error[4] = weight
    if before >= 0.0 and weight != before:
        # The plan jumped under the body: no velocity in that.
        error[0] += (weight - before) * (rx - lx)
        error[1] += (weight - before) * (ry - ly)
    slip = found[5] - plan[9]
    off = (rest * lx + weight * rx, rest * ly + weight * ry)
    turned = (-slip * (rest * lay + weight * ray), slip * (rest * lax + weight * rax))
    filter_error(error, off, (plan[7], plan[8]), turned, gains, period)
    x, y, load = pressure(found, feet)
    if load > 0.0:
        x, y = x - plan[5], y - plan[6]
        x, y = c * x + s * y, c * y - s * x
    w = gains[2]
    dcm = (error[0] + error[2] / w, error[1] + error[3] / w)
    return inclined, dcm, (x, y), (odometry[0], odometry[1], odometry[2])


@njit(cache=True)
def observe(
    joints: Array,
    pads: Array,
    orientation: Array,
    gyro: Array,
    com: Array,
    tilt: Array,
    legs: Array,
    body: Array,
    period: float,
    found: Array,
) -> Point:
    """The body as the sensors have it, in the level frame of the trunk's heading.

    Args:
        joints: their angles (26,) [rad].
        pads: load on front left, front right, back left and back right of either sole (2, 4) [N].
        orientation: attitude of the IMU, quaternion w-x-y-z (4,).
        gyro: angular velocity (3,) [rad/s].
        com: mass centre for the measured joints in the base frame (3,) [m].
        tilt: brought up to date.
        legs: left and right, see `Leg` (2, 6).
        body: share of the IMU's attitude in the tilt per tick [1]; load of a foot that is none
            [N]; middle of a sole ahead of the ankle, half of its length and width [m] (5,).
        period: of control [s].
        found: set to roll, pitch, heading [rad] | angular velocity (3,) [rad/s] | of either foot
            x, y, z [m], yaw [rad], load [N] | mass centre (3,) [m] | share of the load on the right
            foot, half in the air [1] | where in the foot frame either foot's load is, x, y [m]
            (24,).

    Returns:
        roll and pitch [rad].
    """
    quaternion = (orientation[0], orientation[1], orientation[2], orientation[3])
    roll, pitch, heading = roll_pitch_yaw(quaternion)
    follow_tilt(tilt, roll, pitch, gyro, body[0], period)
    found[0], found[1], found[2] = tilt[1], tilt[2], heading
    found[3], found[4], found[5] = gyro[0], gyro[1], gyro[2]
    inclined = (tilt[1], tilt[2])
    for side in range(2):
        leg, own = legs[side], joints[6 * side : 6 * side + 6]
        build = (leg[0], leg[1], leg[2], leg[3], leg[4], leg[5])
        angles = (own[0], own[1], own[2], own[3], own[4], own[5])
        x, y, z, _, _, yaw = foot_pose(build, angles)
        force, ahead, aside = load_of(pads[side], (body[2], body[3], body[4]))
        row = 6 + 5 * side
        found[row], found[row + 1], found[row + 2] = level((x, y, z), inclined)
        found[row + 3], found[row + 4] = yaw, force
        found[20 + 2 * side], found[21 + 2 * side] = ahead, aside
    found[16], found[17], found[18] = level((com[0], com[1], com[2]), inclined)
    on_left, on_right = max(0.0, found[10] - body[1]), max(0.0, found[15] - body[1])
    both = on_left + on_right
    found[19] = on_right / both if both > 0.0 else 0.5
    return inclined


@njit(cache=True)
def roll_pitch_yaw(quaternion: tuple[float, float, float, float]) -> Vector:
    """Roll, pitch and heading of an attitude R = Rz(yaw) Ry(pitch) Rx(roll) [rad]."""
    w, x, y, z = quaternion
    sine = 2.0 * (w * y - x * z)
    cosine = sqrt(max(0.0, 1.0 - sine * sine))
    return (
        atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        atan2(sine, cosine),
        atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )


@njit(cache=True)
def follow_tilt(
    tilt: Array, roll: float, pitch: float, gyro: Array, gain: float, period: float
) -> None:
    """Complementary filter of roll and pitch.

    The gyro is integrated with the coupling that a yawing trunk has (a roll becomes a pitch
    as the body turns under it) and pulled towards the IMU's own attitude.

    Args:
        tilt: brought up to date.
        roll: of the IMU [rad].
        pitch: of the IMU [rad].
        gyro: angular velocity (3,) [rad/s].
        gain: pull per tick [1].
        period: of control [s].
    """
    if tilt[0] == 0.0:
        tilt[0], tilt[1], tilt[2] = 1.0, roll, pitch
        return
    predicted_roll = tilt[1] + period * (gyro[0] + tilt[2] * gyro[2])
    predicted_pitch = tilt[2] + period * (gyro[1] - tilt[1] * gyro[2])
    tilt[1] = predicted_roll + gain * (roll - predicted_roll)
    tilt[2] = predicted_pitch + gain * (pitch - predicted_pitch)


@njit(cache=True)
def load_of(pads: Array, sole: Vector) -> Vector:
    """Load under a sole [N], and where in the foot frame it is, x, y [m]."""
    centre, half_length, half_width = sole
    front_left, front_right, back_left, back_right = pads[0], pads[1], pads[2], pads[3]
    force = front_left + front_right + back_left + back_right
    ahead, aside = centre, 0.0
    if force > 0.0:
        # The floor pushes at the soles' corners.
        length, width = half_length / force, half_width / force
        ahead = centre + length * (front_left + front_right - back_left - back_right)
        aside = width * (front_left + back_left - front_right - back_right)
    return force, ahead, aside


@njit(cache=True)
def pressure(found: Array, feet: Array) -> Vector:
    """Centre of pressure under feet that stand where `feet` are, x, y [m], and the load [N].

    In the air it is nowhere: at 0, 0.
    """
    x = y = load = 0.0
    for side in range(2):
        foot, force = feet[side], found[10 + 5 * side]
        u, v = found[20 + 2 * side], found[21 + 2 * side]
        c, s = cos(foot[2]), sin(foot[2])
        x += force * (foot[0] + c * u - s * v)
        y += force * (foot[1] + s * u + c * v)
        load += force
    return (x / load, y / load, load) if load > 0.0 else (0.0, 0.0, 0.0)


@njit(cache=True)
def reckon(
    odometry: Array,
    heading: float,
    feet: tuple[Point, Point],
    load: float,
    stepping: bool,
    growth: Array,
) -> None:
    """One tick of dead reckoning, see `LegOdometry`.

    Args:
        odometry: brought up to date.
        heading: of the IMU [rad].
        feet: horizontal position of the left and right foot in the robot frame [m].
        load: share of the weight on the right foot [1].
        stepping: whether the feet leave the floor.
        growth: variance of what goes unseen in a tick, forward, to the left [m²], and turning
            [rad²]; share of the feet's sliding against each other that is the foot's that counts
            [1] (4,).
    """
    if odometry[3] != 0.0:
        odometry[2] += (heading - odometry[4] + pi) % (2.0 * pi) - pi
    odometry[3], odometry[4] = 1.0, heading
    yaw = odometry[2]
    c, s = cos(yaw), sin(yaw)
    (lx, ly), (rx, ry) = feet
    left = (s * ly - c * lx, -s * lx - c * ly)
    right = (s * ry - c * rx, -s * rx - c * ry)
    _watch_slip(odometry, left[0] - right[0], left[1] - right[1], load, growth[3])
    if odometry[5] != 0.0:
        if (load if odometry[10] != 0.0 else 1.0 - load) < RELEASED:
            odometry[10] = 1.0 - odometry[10]
        if odometry[10] != 0.0:
            odometry[0] += right[0] - odometry[8]
            odometry[1] += right[1] - odometry[9]
        else:
            odometry[0] += left[0] - odometry[6]
            odometry[1] += left[1] - odometry[7]
        _turn(odometry, growth[2])
        if stepping:
            along, across = growth[0], growth[1]
            odometry[14] += c * c * along + s * s * across
            odometry[15] += c * s * (along - across)
            odometry[17] += s * s * along + c * c * across
    odometry[5] = 1.0
    odometry[6], odometry[7] = left
    odometry[8], odometry[9] = right


@njit(cache=True)
def jump(odometry: Array, displacement: float, turn: float) -> None:
    """An unseen move: standard deviation of it per axis [m] and of its turn [rad]."""
    _turn(odometry, turn * turn)
    odometry[14] += displacement * displacement
    odometry[17] += displacement * displacement


@njit(cache=True)
def _turn(odometry: Array, variance: float) -> None:
    """An unseen turn about where the robot is [rad²]."""
    x, y = odometry[0], odometry[1]
    odometry[14] += y * y * variance
    odometry[15] -= x * y * variance
    odometry[16] += y * variance
    odometry[17] += x * x * variance
    odometry[18] -= x * variance
    odometry[19] += variance


@njit(cache=True)
def _watch_slip(odometry: Array, x: float, y: float, load: float, share: float) -> None:
    """Feet that both carry keep their distance (x, y) unless one of them slips.

    Which of them did, nobody sees; but where feet slide against each other, the foot that
    counts has slipped as well, by a share that was measured.
    """
    if RELEASED <= load <= 1.0 - RELEASED:
        if odometry[11] == 0.0:
            odometry[11], odometry[12], odometry[13] = 1.0, x, y
    elif odometry[11] != 0.0:
        jump(odometry, share * hypot(x - odometry[12], y - odometry[13]), 0.0)
        odometry[11] = 0.0


@njit(cache=True)
def filter_error(
    error: Array, measured: Point, zmp_shift: Point, slip: Point, gains: Array, period: float
) -> None:
    """Steady Kalman filter of e'' = ω² (e - d) + noise, e measured.

    Args:
        error: brought up to date.
        measured: error of the centre of mass [m].
        zmp_shift: d, by how much the ankles moved the ZMP [m].
        slip: velocity that a foot turning on the floor gives the body unseen by the encoders
            [m/s].
        gains: of position [1] and velocity [1/s]; ω [1/s] (3,).
        period: of control [s].
    """
    kp, kv, w = gains[0], gains[1], gains[2]
    for axis in range(2):
        now, rate = error[axis], error[axis + 2]
        change = w * w * (now - zmp_shift[axis])
        predicted = now + period * (rate - slip[axis] + 0.5 * period * change)
        innovation = measured[axis] - predicted
        error[axis] = predicted + kp * innovation
        error[axis + 2] = rate + period * change + kv * innovation


@njit(cache=True)
def com_error(
    com: Point, foot: Vector, reference: Array, planned: Point
) -> tuple[float, float, float, float]:
    """Where the mass centre is by a foot that is taken to stand where it is planned.

    Args:
        com: measured mass centre in the level frame [m].
        foot: measured x, y [m] and yaw [rad] of the foot in the same frame.
        reference: of the foot (10,).
        planned: mass centre [m].

    Returns:
        the mass centre less the planned one, and less the foot, in the plan frame x, y, x, y [m].
    """
    turned = reference[2] - foot[2]
    c, s = cos(turned), sin(turned)
    dx, dy = com[0] - foot[0], com[1] - foot[1]
    x, y = c * dx - s * dy, s * dx + c * dy
    return x + reference[0] - planned[0], y + reference[1] - planned[1], x, y


@njit(cache=True)
def foot_pose(leg: Leg, angles: Angles) -> Pose:
    """Pose of the foot for given joint angles; the inverse is `leg_kernel.leg_angles`."""
    hip_x, hip_y, hip_z, l1, l2, h = leg
    a, b, c, d, e, f = angles
    ca, sa, cb, sb, cf, sf = cos(a), sin(a), cos(b), sin(b), cos(f), sin(f)
    t, g = c + d, c + d + e
    cg, sg = cos(g), sin(g)
    x = -l1 * sin(c) - l2 * sin(t) - h * cf * sg
    z = -l1 * cos(c) - l2 * cos(t) - h * cf * cg
    y = h * sf
    y, z = y * cb - z * sb, y * sb + z * cb
    # Foot axes x and, for the roll, the z components of y and z.
    ux, uy, uz = cg, sg * sb, -sg * cb
    return (
        hip_x + ca * x - sa * y,
        hip_y + sa * x + ca * y,
        hip_z + z,
        atan2(cf * sb + sf * cb * cg, -sf * sb + cf * cb * cg),
        asin(min(1.0, max(-1.0, -uz))),
        atan2(sa * ux + ca * uy, ca * ux - sa * uy),
    )


@njit(cache=True)
def level(point: Vector, tilt: tuple[float, float]) -> Vector:
    """A point of the base frame in the level frame under a tilt by roll and pitch [rad]."""
    cr, sr, cp, sp = cos(tilt[0]), sin(tilt[0]), cos(tilt[1]), sin(tilt[1])
    x, y, z = point
    depth = sr * y + cr * z
    return cp * x + sp * depth, cr * y - sr * z, cp * depth - sp * x
