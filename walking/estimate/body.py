"""State estimation: attitude, feet, loads, and the error of the body against the plan.

Measurements are in the level frame of the trunk's heading: origin in the base, z up. The error of
the centre of mass follows the pendulum, e'' = ω² (e - d) + noise, with d the shift of the ZMP by
the ankles; its filter is a steady-state Kalman filter.
"""

from math import atan2, cos, cosh, sin, sinh, sqrt

import numpy as np
from scipy.linalg import solve_discrete_are

from compilation import compiled
from compilation.record import Records
from walking.body.kinematics import MOVE, frame_pose, inclined, rotated, tree_pass
from walking.data import Body, Data, DeadReckoning, FootReference, PlanError
from walking.estimate.odometry import reckon
from walking.model import LEFT, RIGHT, Link, Model, Sole
from walking.parameters import CONTROL_PERIOD, EstimatorParameters
from walking.plan.balance import is_fallen
from walking.plan.gait import right_weight
from walking.plan.pendulum import dcm
from walking.plane import Array, Indices, Point, Vector, from_frame, rotate, rotate_back


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


@compiled
def measure(
    walks: Records[Data],
    angles: Array,
    orientation: Array,
    gyro: Array,
    pads: Array,
    links: Records[Link],
    order: Indices,
    robots: Records[Model],
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
    walk, robot, poses = walks[0], robots[0], np.empty((links.size, 12))
    com = tree_pass(links, order, angles, poses)
    for k in range(3):
        frame_pose(walk.body.frames[k], poses[robot.carriers[k]], robot.frames[k])
    set_body(walk.body, com, orientation, gyro, pads, robot)
    walk.ticks += 1
    return is_fallen(walk.body, robot)


@compiled
def set_body(
    body: Body,
    com: Vector,
    orientation: Array,
    gyro: Array,
    pads: Array,
    robot: Model,
) -> None:
    """Set the measured body from `body.frames`, which must be set, and filter its tilt.

    Args:
        body: changed.
        com: centre of mass for the measured joints in the base frame [m].
        orientation: attitude of the IMU, quaternion w-x-y-z (4,).
        gyro: angular velocity (3,) [rad/s].
        pads: load on front left, front right, back left and back right of each sole (2, 4) [N].
        robot: constants.
    """
    roll, pitch, body.heading = roll_pitch_yaw(orientation)
    follow_tilt(body, roll, pitch, gyro, robot.estimator.tilt_gain)
    attitude = inclined(body.roll, body.pitch)
    # Of the heading, not about the axis of the trunk.
    body.turn_rate = (sin(body.roll) * gyro[1] + cos(body.roll) * gyro[2]) / cos(body.pitch)
    for side in range(2):
        foot, frame = body.feet[side], body.frames[side]
        x, y, z = frame[MOVE], frame[MOVE + 1], frame[MOVE + 2]
        foot.x, foot.y, foot.z = rotated(attitude, x, y, z)
        ahead, aside, _ = rotated(attitude, frame[0], frame[3], frame[6])
        foot.yaw = atan2(aside, ahead)
        foot.load, foot.pressure_x, foot.pressure_y = load_of(pads[side], robot.sole)
    x, y, z = com
    body.com_x, body.com_y, body.com_z = rotated(attitude, x, y, z)
    left = max(0.0, body.feet[LEFT].load - robot.light_load)
    right = max(0.0, body.feet[RIGHT].load - robot.light_load)
    both = left + right
    body.right_load = right / both if both > 0.0 else 0.5


@compiled
def base_height(body: Body) -> float:
    """Return the height of the base above the loaded feet [m]."""
    load, left, right = body.right_load, body.feet[LEFT], body.feet[RIGHT]
    return -(1.0 - load) * left.z - load * right.z


@compiled
def update_error(walk: Data, robot: Model) -> None:
    """Update the errors of CoM, DCM and centre of pressure against the plan of the last tick.

    Args:
        walk: measured body and plan of the last tick; the error is changed.
        robot: constants.
    """
    weight = right_weight(walk.plan.gait)
    body, error, limbs, pendulum = walk.body, walk.error, walk.limbs, walk.pendulum
    left, right = limbs.feet[LEFT], limbs.feet[RIGHT]
    frame = (limbs.pelvis.x, limbs.pelvis.y, limbs.pelvis.yaw)
    planned = from_frame(frame, limbs.com_x, limbs.com_y)
    lx, ly, lax, lay = _com_error(body, LEFT, left, planned)
    rx, ry, rax, ray = _com_error(body, RIGHT, right, planned)
    left_weight, before = 1.0 - weight, error.right_weight
    if error.weighted and weight != before:
        # A jump of the plan, not a velocity of the body.
        error.x += (weight - before) * (rx - lx)
        error.y += (weight - before) * (ry - ly)
    error.weighted, error.right_weight = True, weight
    slip = body.turn_rate - limbs.turn_rate
    off = (left_weight * lx + weight * rx, left_weight * ly + weight * ry)
    arm_x = left_weight * lax + weight * rax
    arm_y = left_weight * lay + weight * ray
    filter_error(
        error, off, (walk.zmp_shift.x, walk.zmp_shift.y), (-slip * arm_y, slip * arm_x), robot
    )
    x, y, load = pressure(body, (left.x, left.y, left.yaw), (right.x, right.y, right.yaw))
    error.pressed = load > 0.0
    if error.pressed:
        x, y = rotate_back(limbs.pelvis.yaw, x - pendulum.zmp_x, y - pendulum.zmp_y)
    error.pressure_x, error.pressure_y = x, y
    error.dcm_x, error.dcm_y = dcm(error.x, error.vx, robot), dcm(error.y, error.vy, robot)


@compiled
def reckon_body(odometry: DeadReckoning, body: Body, stepping: bool) -> None:
    """Run one tick of dead reckoning from the measured body."""
    left, right = body.feet[LEFT], body.feet[RIGHT]
    feet = ((left.x, left.y), (right.x, right.y))
    reckon(odometry, body.heading, feet, body.right_load, stepping)


@compiled
def roll_pitch_yaw(orientation: Array) -> Vector:
    """Return roll, pitch and heading of an attitude R = Rz(yaw) Ry(pitch) Rx(roll) [rad].

    Args:
        orientation: attitude, quaternion w-x-y-z (4,).
    """
    w, x, y, z = orientation[0], orientation[1], orientation[2], orientation[3]
    sine = 2.0 * (w * y - x * z)
    cosine = sqrt(max(0.0, 1.0 - sine * sine))
    return (
        atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        atan2(sine, cosine),
        atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )


@compiled
def follow_tilt(body: Body, roll: float, pitch: float, gyro: Array, gain: float) -> None:
    """Update the complementary filter of roll and pitch.

    The gyro is integrated, with the coupling of roll and pitch by the yaw rate, and corrected
    towards the attitude of the IMU.

    Args:
        body: changed.
        roll: roll of the IMU [rad].
        pitch: pitch of the IMU [rad].
        gyro: angular velocity (3,) [rad/s].
        gain: correction per tick [1].
    """
    s = body
    if not s.started:
        s.started, s.roll, s.pitch = True, roll, pitch
        return
    predicted_roll = s.roll + CONTROL_PERIOD * (gyro[0] + s.pitch * gyro[2])
    predicted_pitch = s.pitch + CONTROL_PERIOD * (gyro[1] - s.roll * gyro[2])
    s.roll = predicted_roll + gain * (roll - predicted_roll)
    s.pitch = predicted_pitch + gain * (pitch - predicted_pitch)


@compiled
def load_of(pads: Array, sole: Sole) -> Vector:
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
def pressure(body: Body, left: Vector, right: Vector) -> Vector:
    """Return centre of pressure (0, 0 in the air) x, y [m] and load [N] of feet at x, y, yaw."""
    x = y = load = 0.0
    for side in range(2):
        frame, foot = right if side == RIGHT else left, body.feet[side]
        px, py = from_frame(frame, foot.pressure_x, foot.pressure_y)
        x += foot.load * px
        y += foot.load * py
        load += foot.load
    return (x / load, y / load, load) if load > 0.0 else (0.0, 0.0, 0.0)


@compiled
def filter_error(
    error: PlanError, measured: Point, zmp_shift: Point, slip: Point, robot: Model
) -> None:
    """Update the filter of the CoM error.

    Args:
        error: x, y, vx, vy are changed.
        measured: error of the centre of mass [m].
        zmp_shift: d, shift of the ZMP by the ankles [m].
        slip: velocity of the body from a stance foot that turns on the floor, not measured by the
            encoders [m/s].
        robot: constants.
    """
    e, (x, y), (dx, dy), (vx, vy) = error, measured, zmp_shift, slip
    e.x, e.vx = _filter_axis(e.x, e.vx, x, dx, vx, robot)
    e.y, e.vy = _filter_axis(e.y, e.vy, y, dy, vy, robot)


@compiled
def _filter_axis(
    now: float, rate: float, measured: float, zmp_shift: float, slip: float, robot: Model
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
    body: Body, side: int, reference: FootReference, planned: Point
) -> tuple[float, float, float, float]:
    """Return the error of the centre of mass, given a foot at its planned position.

    Returns:
        measured minus planned centre of mass, and measured centre of mass minus foot, in the plan
        frame x, y, x, y [m].
    """
    foot = body.feet[side]
    x, y = rotate(reference.yaw - foot.yaw, body.com_x - foot.x, body.com_y - foot.y)
    return x + reference.x - planned[0], y + reference.y - planned[1], x, y
