"""State estimation in every control tick, compiled.

State arrays, booleans as 0 or 1:

    tilt (3,)       initialized | roll, pitch [rad];
    odometry (20,)  x, y [m], unwrapped heading [rad] | IMU heading known, its value [rad] |
                    vectors from foot to body known, their values in the odometry frame: left x, y,
                    right x, y [m] | index of the stance foot | double support, distance of the feet
                    at its begin x, y [m] | xx, xy, xw, yy, yw, ww of the error covariance;
    error (5,)      x, y [m], vx, vy [m/s] | weight on the right foot [1], -1 before the first tick.

Constant numbers are passed in arrays, too: tuples are unpacked at every call.
"""

from math import atan2, cos, pi, sin, sqrt

from compilation import compiled
from walking.arrays import Array, Point, Vector

Plan = tuple[float, float, float, float, float, float, float, float, float, float, float]
"""Pelvis x, y [m], heading [rad]; centre of mass in the base frame x, y; ZMP x, y; its shift by the
ankles x, y [m]; yaw rate [rad/s]; weight on the right foot [1]."""

RELEASED = 0.2  # load fraction below which a foot is not the stance foot [1]
MEASURED, LOAD = 24, 10  # number of measurements; index of the left foot's load


@compiled
def estimate(
    legs: Array,
    pads: Array,
    orientation: Array,
    gyro: Array,
    com: Array,
    tilt: Array,
    odometry: Array,
    error: Array,
    body: Array,
    growth: Array,
    gains: Array,
    feet: Array,
    plan: Plan,
    stepping: bool,
    period: float,
    measured: Array,
) -> tuple[Point, Point, Point, Vector]:
    """Run one tick: `observe`, odometry, and the error against the plan.

    Arguments as in `observe`, `reckon` (odometry, growth) and `filter_error` (error, gains). `feet`
    are the foot references, see `walking.gait.swing_foot_kernel` (2, 10); `plan` is that of the
    last tick; `stepping` is whether a footstep is under way.

    Returns:
        roll and pitch [rad]; DCM error in the plan frame [m]; error of the centre of pressure,
        forward and left, zero in the air [m]; odometry pose [m, m, rad].
    """
    inclined = observe(legs, pads, orientation, gyro, com, tilt, body, period, measured)
    left, right = (measured[6], measured[7]), (measured[11], measured[12])
    reckon(odometry, measured[2], (left, right), measured[19], stepping, growth)
    yaw, weight = plan[2], plan[10]
    c, s = cos(yaw), sin(yaw)
    planned = (plan[0] + c * plan[3] - s * plan[4], plan[1] + s * plan[3] + c * plan[4])
    com_now = (measured[16], measured[17])
    lx, ly, lax, lay = com_error(com_now, (left[0], left[1], measured[9]), feet[0], planned)
    rx, ry, rax, ray = com_error(com_now, (right[0], right[1], measured[14]), feet[1], planned)
    rest, before = 1.0 - weight, error[4]
    error[4] = weight
    if before >= 0.0 and weight != before:
        # A jump of the plan, not a velocity of the body.
        error[0] += (weight - before) * (rx - lx)
        error[1] += (weight - before) * (ry - ly)
    slip = measured[5] - plan[9]
    off = (rest * lx + weight * rx, rest * ly + weight * ry)
    turned = (-slip * (rest * lay + weight * ray), slip * (rest * lax + weight * rax))
    filter_error(error, off, (plan[7], plan[8]), turned, gains, period)
    x, y, load = pressure(measured, feet)
    if load > 0.0:
        x, y = x - plan[5], y - plan[6]
        x, y = c * x + s * y, c * y - s * x
    w = gains[2]
    dcm = (error[0] + error[2] / w, error[1] + error[3] / w)
    return inclined, dcm, (x, y), (odometry[0], odometry[1], odometry[2])


@compiled
def observe(
    legs: Array,
    pads: Array,
    orientation: Array,
    gyro: Array,
    com: Array,
    tilt: Array,
    body: Array,
    period: float,
    measured: Array,
) -> Point:
    """Measure the body in the level frame of the trunk's heading.

    Args:
        legs: x, y, z [m] and yaw [rad] of the left and the right foot in the base frame (2, 4).
        pads: load on front left, front right, back left and back right of each sole (2, 4) [N].
        orientation: attitude of the IMU, quaternion w-x-y-z (4,).
        gyro: angular velocity (3,) [rad/s].
        com: centre of mass for the measured joints in the base frame (3,) [m].
        tilt: updated.
        body: filter gain of the tilt per tick [1]; load below which a foot is unloaded [N]; centre
            of a sole ahead of the ankle, half of its length and width [m] (5,).
        period: of control [s].
        measured: set to roll, pitch, heading [rad] | angular velocity (3,) [rad/s] | of each foot
            x, y, z [m], yaw [rad], load [N] | centre of mass (3,) [m] | load fraction of the right
            foot, 0.5 in the air [1] | centre of pressure of each foot in its frame x, y [m] (24,).

    Returns:
        roll and pitch [rad].
    """
    quaternion = (orientation[0], orientation[1], orientation[2], orientation[3])
    roll, pitch, heading = roll_pitch_yaw(quaternion)
    follow_tilt(tilt, roll, pitch, gyro, body[0], period)
    measured[0], measured[1], measured[2] = tilt[1], tilt[2], heading
    measured[3], measured[4], measured[5] = gyro[0], gyro[1], gyro[2]
    inclined = (tilt[1], tilt[2])
    for side in range(2):
        x, y, z, yaw = legs[side, 0], legs[side, 1], legs[side, 2], legs[side, 3]
        force, ahead, aside = load_of(pads[side], (body[2], body[3], body[4]))
        row = 6 + 5 * side
        measured[row], measured[row + 1], measured[row + 2] = level((x, y, z), inclined)
        measured[row + 3], measured[row + 4] = yaw, force
        measured[20 + 2 * side], measured[21 + 2 * side] = ahead, aside
    measured[16], measured[17], measured[18] = level((com[0], com[1], com[2]), inclined)
    on_left, on_right = max(0.0, measured[10] - body[1]), max(0.0, measured[15] - body[1])
    both = on_left + on_right
    measured[19] = on_right / both if both > 0.0 else 0.5
    return inclined


@compiled
def roll_pitch_yaw(quaternion: tuple[float, float, float, float]) -> Vector:
    """Return roll, pitch and heading of an attitude R = Rz(yaw) Ry(pitch) Rx(roll) [rad]."""
    w, x, y, z = quaternion
    sine = 2.0 * (w * y - x * z)
    cosine = sqrt(max(0.0, 1.0 - sine * sine))
    return (
        atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        atan2(sine, cosine),
        atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )


@compiled
def follow_tilt(
    tilt: Array, roll: float, pitch: float, gyro: Array, gain: float, period: float
) -> None:
    """Update the complementary filter of roll and pitch.

    The gyro is integrated, with the coupling of roll and pitch by the yaw rate, and corrected
    towards the attitude of the IMU.

    Args:
        tilt: updated.
        roll: of the IMU [rad].
        pitch: of the IMU [rad].
        gyro: angular velocity (3,) [rad/s].
        gain: correction per tick [1].
        period: of control [s].
    """
    if tilt[0] == 0.0:
        tilt[0], tilt[1], tilt[2] = 1.0, roll, pitch
        return
    predicted_roll = tilt[1] + period * (gyro[0] + tilt[2] * gyro[2])
    predicted_pitch = tilt[2] + period * (gyro[1] - tilt[1] * gyro[2])
    tilt[1] = predicted_roll + gain * (roll - predicted_roll)
    tilt[2] = predicted_pitch + gain * (pitch - predicted_pitch)


@compiled
def load_of(pads: Array, sole: Vector) -> Vector:
    """Return the load on a sole [N] and its centre of pressure in the foot frame x, y [m]."""
    centre, half_length, half_width = sole
    front_left, front_right, back_left, back_right = pads[0], pads[1], pads[2], pads[3]
    force = front_left + front_right + back_left + back_right
    ahead, aside = centre, 0.0
    if force > 0.0:
        # Contact forces act at the corners of the sole.
        length, width = half_length / force, half_width / force
        ahead = centre + length * (front_left + front_right - back_left - back_right)
        aside = width * (front_left + back_left - front_right - back_right)
    return force, ahead, aside


@compiled
def pressure(measured: Array, feet: Array) -> Vector:
    """Return centre of pressure (0, 0 in the air) x, y [m] and load [N] of feet at `feet`."""
    x = y = load = 0.0
    for side in range(2):
        foot, force = feet[side], measured[10 + 5 * side]
        u, v = measured[20 + 2 * side], measured[21 + 2 * side]
        c, s = cos(foot[2]), sin(foot[2])
        x += force * (foot[0] + c * u - s * v)
        y += force * (foot[1] + s * u + c * v)
        load += force
    return (x / load, y / load, load) if load > 0.0 else (0.0, 0.0, 0.0)


@compiled
def reckon(
    odometry: Array,
    heading: float,
    feet: tuple[Point, Point],
    load: float,
    stepping: bool,
    growth: Array,
) -> None:
    """Run one tick of dead reckoning, see `LegOdometry`.

    Args:
        odometry: updated.
        heading: of the IMU [rad].
        feet: horizontal position of the left and right foot in the robot frame [m].
        load: load fraction of the right foot [1].
        stepping: whether a footstep is under way.
        growth: unmeasured variance per tick forward, lateral [m²] and of the yaw [rad²]; slip of
            the stance foot per relative slip of the feet [1] (4,).
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


@compiled
def jump(odometry: Array, displacement: float, turn: float) -> None:
    """Add an unmeasured motion: standard deviation per axis [m] and of the yaw [rad]."""
    _turn(odometry, turn * turn)
    odometry[14] += displacement * displacement
    odometry[17] += displacement * displacement


@compiled
def _turn(odometry: Array, variance: float) -> None:
    """Add an unmeasured turn about the present position [rad²]."""
    x, y = odometry[0], odometry[1]
    odometry[14] += y * y * variance
    odometry[15] -= x * y * variance
    odometry[16] += y * variance
    odometry[17] += x * x * variance
    odometry[18] -= x * variance
    odometry[19] += variance


@compiled
def _watch_slip(odometry: Array, x: float, y: float, load: float, ratio: float) -> None:
    """Add the slip of a double support to the covariance.

    A change of the distance (x, y) between the feet is slip of either foot; the slip of the stance
    foot is a fixed ratio of it, determined by experiment.
    """
    if RELEASED <= load <= 1.0 - RELEASED:
        if odometry[11] == 0.0:
            odometry[11], odometry[12], odometry[13] = 1.0, x, y
    elif odometry[11] != 0.0:
        dx, dy = x - odometry[12], y - odometry[13]
        jump(odometry, ratio * sqrt(dx * dx + dy * dy), 0.0)
        odometry[11] = 0.0


@compiled
def filter_error(
    error: Array, measured: Point, zmp_shift: Point, slip: Point, gains: Array, period: float
) -> None:
    """Update the steady-state Kalman filter of e'' = ω² (e - d) + noise, e measured.

    Args:
        error: updated.
        measured: error of the centre of mass [m].
        zmp_shift: d, shift of the ZMP by the ankles [m].
        slip: velocity of the body from a stance foot that turns on the floor, not measured by the
            encoders [m/s].
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


@compiled
def com_error(
    com: Point, foot: Vector, reference: Array, planned: Point
) -> tuple[float, float, float, float]:
    """Return the error of the centre of mass, given a foot at its planned position.

    Args:
        com: measured centre of mass in the level frame [m].
        foot: measured x, y [m] and yaw [rad] of the foot in that frame.
        reference: of the foot (10,).
        planned: centre of mass [m].

    Returns:
        measured minus planned centre of mass, and measured centre of mass minus foot, in the plan
        frame x, y, x, y [m].
    """
    turned = reference[2] - foot[2]
    c, s = cos(turned), sin(turned)
    dx, dy = com[0] - foot[0], com[1] - foot[1]
    x, y = c * dx - s * dy, s * dx + c * dy
    return x + reference[0] - planned[0], y + reference[1] - planned[1], x, y


@compiled
def level(point: Vector, tilt: Point) -> Vector:
    """Transform a point of the base frame to the level frame, given roll and pitch [rad]."""
    cr, sr, cp, sp = cos(tilt[0]), sin(tilt[0]), cos(tilt[1]), sin(tilt[1])
    x, y, z = point
    depth = sr * y + cr * z
    return cp * x + sp * depth, cr * y - sr * z, cp * depth - sp * x
