"""State estimation: attitude, feet, loads, and the error of the body against the plan.

Measurements are in the level frame of the trunk's heading: origin in the base, z up. The error of
the centre of mass follows the pendulum, e'' = ω² (e - d) + noise, with d the shift of the ZMP by
the ankles; its filter is a steady-state Kalman filter.
"""

from math import atan2, cos, cosh, sin, sinh, sqrt

import numpy as np
from scipy.linalg import solve_discrete_are

from compilation import compiled
from compilation.record import record_type
from walking.body.kinematics import MOVE, frame_pose, tree_pass
from walking.body.robot_model import RobotModel
from walking.odometry import reckon
from walking.parameters import CONTROL_PERIOD, EstimatorParameters
from walking.plane import Array, Indices, Point, Vector, from_frame, norm, rotate, rotate_back
from walking.records import Record
from walking.state import BodySensors

FOOT = record_type(
    x=float, y=float, z=float, yaw=float, load=float, pressure_x=float, pressure_y=float
)
"""Measured foot: position [m] and yaw [rad] in the level frame of the heading, load [N], centre of
pressure in the foot frame [m]."""

SENSING = record_type(
    started=bool,
    roll=float,
    pitch=float,
    heading=float,
    turn_rate=float,
    frames=(float, 3, 12),
    feet=(FOOT, 2),
    com=(float, 3),
    right_load=float,
    # Error of the body against the plan.
    x=float,
    y=float,
    vx=float,
    vy=float,
    weighted=bool,
    right_weight=float,
    dcm_x=float,
    dcm_y=float,
    pressure_x=float,
    pressure_y=float,
)
"""Measured body: filtered roll and pitch, heading of the IMU [rad]; yaw rate [rad/s]; rotation, row
by row, and position of left foot, right foot and camera in the base frame [m]; feet; centre of mass
[m]; load fraction of the right foot, 0.5 in the air [1]. Error of the CoM, x, y [m], vx, vy
[m/s]; planned load fraction of the right foot, once known; error of the DCM in the plan frame [m],
of the centre of pressure forward and left [m]."""

CAMERA_FRAME = 2
"""Index of the camera in `SENSING.frames`; the feet have 0 and 1."""


def steady_gains(omega: float, parameters: EstimatorParameters) -> tuple[float, float]:
    """Return the gains of position [1] and velocity [1/s] of e'' = ω² (e - d) + noise."""
    dt = CONTROL_PERIOD
    wh = omega * dt
    A = np.array([[cosh(wh), sinh(wh) / omega], [omega * sinh(wh), cosh(wh)]])
    G = np.array([[0.5 * dt * dt], [dt]]) * parameters.acceleration_noise
    C = np.array([[1.0, 0.0]])
    R = np.array([[parameters.position_noise**2]])
    # A little noise on the position itself keeps the Riccati equation well posed.
    Q = G @ G.T + np.diag([1e-12, 0.0])
    P = solve_discrete_are(A.T, C.T, Q, R)
    position, velocity = (P @ C.T / (C @ P @ C.T + R)).ravel().tolist()
    return position, velocity


def sense(walks: Record, sensors: BodySensors, robot: RobotModel, robots: Record) -> bool:
    """Measure the body; return whether the robot is fallen.

    Args:
        walks: state (1,), changed.
        sensors: read in this tick.
        robot: model of the robot.
        robots: constants (1,).
    """
    rest = (sensors.orientation, sensors.gyro, sensors.foot_force, robot.links, robot.order, robots)
    fallen: bool = watch(walks, sensors.joint_position, *rest)
    return fallen


@compiled
def watch(
    walks: Record,
    angles: Array,
    orientation: Array,
    gyro: Array,
    pads: Array,
    links: Array,
    order: Indices,
    robots: Record,
) -> bool:
    """Measure the body; return whether the robot is fallen.

    Args:
        walks: state (1,), changed.
        angles: measured angles of all joints (n,) [rad].
        orientation: attitude of the IMU, quaternion w-x-y-z (4,).
        gyro: angular velocity of the trunk (3,) [rad/s].
        pads: load on the pads of each sole (2, 4) [N].
        links: links of the robot, see `walking.body.kinematics.tree_pass`.
        order: order of its joints.
        robots: constants (1,).
    """
    walk, robot, poses = walks[0], robots[0], np.empty((links.shape[0], 12))
    com = tree_pass(links, order, angles, poses)
    for k in range(3):
        frame_pose(walk.sensing.frames[k], poses[robot.carriers[k]], robot.frames[k])
    measure(walk.sensing, com, orientation, gyro, pads, robot)
    walk.ticks += 1
    return is_fallen(walk.sensing, robot)


@compiled
def measure(
    sensing: Record,
    com: Vector,
    orientation: Array,
    gyro: Array,
    pads: Array,
    robot: Record,
) -> None:
    """Measure the body from `sensing.frames`, which must be set, and filter its tilt.

    Args:
        sensing: changed.
        com: centre of mass for the measured joints in the base frame [m].
        orientation: attitude of the IMU, quaternion w-x-y-z (4,).
        gyro: angular velocity (3,) [rad/s].
        pads: load on front left, front right, back left and back right of each sole (2, 4) [N].
        robot: constants.
    """
    w, x, y, z = orientation[0], orientation[1], orientation[2], orientation[3]
    roll, pitch, sensing.heading = roll_pitch_yaw(w, x, y, z)
    follow_tilt(sensing, roll, pitch, gyro, robot.estimator.tilt_gain)
    sensing.turn_rate = gyro[2]
    tilt = (sensing.roll, sensing.pitch)
    for side in range(2):
        foot, frame = sensing.feet[side], sensing.frames[side]
        foot.x, foot.y, foot.z = level((frame[MOVE], frame[MOVE + 1], frame[MOVE + 2]), tilt)
        foot.yaw = atan2(frame[3], frame[0])
        foot.load, foot.pressure_x, foot.pressure_y = load_of(pads[side], robot.sole)
    sensing.com[0], sensing.com[1], sensing.com[2] = level(com, tilt)
    left = max(0.0, sensing.feet[0].load - robot.light_load)
    right = max(0.0, sensing.feet[1].load - robot.light_load)
    both = left + right
    sensing.right_load = right / both if both > 0.0 else 0.5


@compiled
def base_height(sensing: Record) -> float:
    """Return the height of the base above the loaded feet [m]."""
    load, left, right = sensing.right_load, sensing.feet[0], sensing.feet[1]
    height: float = -(1.0 - load) * left.z - load * right.z
    return height


@compiled
def is_fallen(sensing: Record, robot: Record) -> bool:
    """Whether the tilt of the trunk is that of a fallen robot."""
    fallen: bool = norm(sensing.roll, sensing.pitch) > robot.estimator.fall_tilt
    return fallen


@compiled
def compare_with_plan(sensing: Record, walk: Record, robot: Record, right_weight: float) -> None:
    """Update the errors of CoM, DCM and centre of pressure against the plan of the last tick.

    Args:
        sensing: changed.
        walk: state of the last tick.
        robot: constants.
        right_weight: planned load fraction of the right foot [1].
    """
    limbs, pendulum = walk.limbs, walk.pendulum
    frame = (limbs.pelvis[0], limbs.pelvis[1], limbs.pelvis[2])
    planned = from_frame(frame, limbs.com[0], limbs.com[1])
    lx, ly, lax, lay = _com_error(sensing, 0, limbs.feet[0], planned)
    rx, ry, rax, ray = _com_error(sensing, 1, limbs.feet[1], planned)
    rest, before = 1.0 - right_weight, sensing.right_weight
    if sensing.weighted and right_weight != before:
        # A jump of the plan, not a velocity of the body.
        sensing.x += (right_weight - before) * (rx - lx)
        sensing.y += (right_weight - before) * (ry - ly)
    sensing.weighted, sensing.right_weight = True, right_weight
    slip = sensing.turn_rate - limbs.turn_rate
    off = (rest * lx + right_weight * rx, rest * ly + right_weight * ry)
    turned = (-slip * (rest * lay + right_weight * ray), slip * (rest * lax + right_weight * rax))
    filter_error(sensing, off, (walk.zmp_shift_x, walk.zmp_shift_y), turned, robot)
    feet, w = limbs.feet, robot.omega
    left, right = feet[0], feet[1]
    x, y, load = pressure(sensing, (left.x, left.y, left.yaw), (right.x, right.y, right.yaw))
    if load > 0.0:
        x, y = rotate_back(frame[2], x - pendulum.zmp_x, y - pendulum.zmp_y)
    sensing.pressure_x, sensing.pressure_y = x, y
    sensing.dcm_x, sensing.dcm_y = sensing.x + sensing.vx / w, sensing.y + sensing.vy / w


@compiled
def estimate(
    walk: Record, odometry: Record, right_weight: float, stepping: bool, robot: Record
) -> None:
    """Run one tick of odometry and of the errors against the plan, after `measure`."""
    sensing = walk.sensing
    left, right = sensing.feet[0], sensing.feet[1]
    feet = ((left.x, left.y), (right.x, right.y))
    reckon(odometry, sensing.heading, feet, sensing.right_load, stepping)
    compare_with_plan(sensing, walk, robot, right_weight)


@compiled
def roll_pitch_yaw(w: float, x: float, y: float, z: float) -> Vector:
    """Return roll, pitch and heading of an attitude R = Rz(yaw) Ry(pitch) Rx(roll) [rad]."""
    sine = 2.0 * (w * y - x * z)
    cosine = sqrt(max(0.0, 1.0 - sine * sine))
    return (
        atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        atan2(sine, cosine),
        atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )


@compiled
def follow_tilt(sensing: Record, roll: float, pitch: float, gyro: Array, gain: float) -> None:
    """Update the complementary filter of roll and pitch.

    The gyro is integrated, with the coupling of roll and pitch by the yaw rate, and corrected
    towards the attitude of the IMU.

    Args:
        sensing: changed.
        roll: roll of the IMU [rad].
        pitch: pitch of the IMU [rad].
        gyro: angular velocity (3,) [rad/s].
        gain: correction per tick [1].
    """
    s = sensing
    if not s.started:
        s.started, s.roll, s.pitch = True, roll, pitch
        return
    predicted_roll = s.roll + CONTROL_PERIOD * (gyro[0] + s.pitch * gyro[2])
    predicted_pitch = s.pitch + CONTROL_PERIOD * (gyro[1] - s.roll * gyro[2])
    s.roll = predicted_roll + gain * (roll - predicted_roll)
    s.pitch = predicted_pitch + gain * (pitch - predicted_pitch)


@compiled
def load_of(pads: Array, sole: Record) -> Vector:
    """Return the load on a sole [N] and its centre of pressure in the foot frame x, y [m]."""
    front_left, front_right, back_left, back_right = pads[0], pads[1], pads[2], pads[3]
    force = front_left + front_right + back_left + back_right
    ahead, aside = sole.centre, 0.0
    if force > 0.0:
        # Contact forces act at the corners of the sole.
        length, width = sole.half_length / force, sole.half_width / force
        ahead = sole.centre + length * (front_left + front_right - back_left - back_right)
        aside = width * (front_left + back_left - front_right - back_right)
    return force, ahead, aside


@compiled
def pressure(sensing: Record, left: Vector, right: Vector) -> Vector:
    """Return centre of pressure (0, 0 in the air) x, y [m] and load [N] of feet at x, y, yaw."""
    x = y = load = 0.0
    for side in range(2):
        frame, foot = right if side == 1 else left, sensing.feet[side]
        px, py = from_frame(frame, foot.pressure_x, foot.pressure_y)
        x += foot.load * px
        y += foot.load * py
        load += foot.load
    return (x / load, y / load, load) if load > 0.0 else (0.0, 0.0, 0.0)


@compiled
def filter_error(
    sensing: Record, measured: Point, zmp_shift: Point, slip: Point, robot: Record
) -> None:
    """Update the filter of the CoM error.

    Args:
        sensing: x, y, vx, vy are changed.
        measured: error of the centre of mass [m].
        zmp_shift: d, shift of the ZMP by the ankles [m].
        slip: velocity of the body from a stance foot that turns on the floor, not measured by the
            encoders [m/s].
        robot: constants.
    """
    s = sensing
    s.x, s.vx = _filter_axis(s.x, s.vx, measured[0], zmp_shift[0], slip[0], robot)
    s.y, s.vy = _filter_axis(s.y, s.vy, measured[1], zmp_shift[1], slip[1], robot)


@compiled
def _filter_axis(
    now: float, rate: float, measured: float, zmp_shift: float, slip: float, robot: Record
) -> Point:
    w, period = robot.omega, CONTROL_PERIOD
    change = w * w * (now - zmp_shift)
    predicted = now + period * (rate - slip + 0.5 * period * change)
    innovation = measured - predicted
    return (
        predicted + robot.position_gain * innovation,
        rate + period * change + robot.velocity_gain * innovation,
    )


@compiled
def _com_error(
    sensing: Record, side: int, reference: Record, planned: Point
) -> tuple[float, float, float, float]:
    """Return the error of the centre of mass, given a foot at its planned position.

    Returns:
        measured minus planned centre of mass, and measured centre of mass minus foot, in the plan
        frame x, y, x, y [m].
    """
    foot = sensing.feet[side]
    turned = reference.yaw - foot.yaw
    x, y = rotate(turned, sensing.com[0] - foot.x, sensing.com[1] - foot.y)
    return x + reference.x - planned[0], y + reference.y - planned[1], x, y


@compiled
def level(point: Vector, tilt: Point) -> Vector:
    """Transform a point of the base frame to the level frame, given roll and pitch [rad]."""
    cr, sr, cp, sp = cos(tilt[0]), sin(tilt[0]), cos(tilt[1]), sin(tilt[1])
    x, y, z = point
    depth = sr * y + cr * z
    return cp * x + sp * depth, cr * y - sr * z, cp * depth - sp * x
