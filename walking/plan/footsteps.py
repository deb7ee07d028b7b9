"""Footsteps: velocities and command states become strides, strides become footholds.

The foot on the side of a lateral or turning motion opens the stance by twice the motion of one
footstep, the other foot closes it again; so the feet never cross and the mean velocity is the
commanded one.
"""

from math import cos, sin, sqrt
from typing import NamedTuple

from compilation import compiled
from walking.command import CLEARANCE, REACH, STEP_LENGTH, STEP_SIDE, STEP_TURN
from walking.data import StepCommand, Timing
from walking.model import FootholdRecord, Model, Sole, Strides
from walking.parameters import CONTROL_PERIOD
from walking.plane import Point, Vector, clamp, from_frame, rotate_back

POSITION_TOLERANCE = 0.024  # of close footholds, per half stance [1]
YAW_TOLERANCE = 1e-3  # of close footholds [rad]
STANCE_TOLERANCE = 0.6  # of a parallel stance, per half stance [1]
STANCE_YAW_TOLERANCE = 0.05  # of a parallel stance [rad]
STILL = (0.0, 0.0, 0.0)
RIGHT, LEFT = -1.0, 1.0  # side of the body

StepValues = tuple[float, float, float, float, float, float]
"""Fields of a `walking.command.CommandState` in order."""


class Foothold(NamedTuple):
    """Pose of a foot on the floor, in the plan frame; in a `WalkingState`, in the odometry frame.

    Attributes:
        left: whether it is the left foot.
        x, y: position of the foot frame on the floor [m].
        yaw: yaw of the foot [rad].
    """

    left: bool
    x: float
    y: float
    yaw: float


@compiled
def foothold(record: FootholdRecord) -> Foothold:
    """Return the foothold in a record."""
    return Foothold(record.left, record.x, record.y, record.yaw)


@compiled
def put(record: FootholdRecord, foot: Foothold) -> None:
    """Set a record to a foothold."""
    record.left, record.x, record.y, record.yaw = foot.left, foot.x, foot.y, foot.yaw


@compiled
def towards(one: Foothold, other: Foothold, fraction: float) -> Foothold:
    """Interpolate linearly to another foothold of the same foot."""
    return Foothold(
        other.left,
        one.x + fraction * (other.x - one.x),
        one.y + fraction * (other.y - one.y),
        one.yaw + fraction * (other.yaw - one.yaw),
    )


@compiled
def placed(support: Foothold, x: float, y: float, yaw: float) -> Foothold:
    """Return the other foot at x, y [m] and yaw [rad] in the frame of the support foot."""
    px, py = from_frame((support.x, support.y, support.yaw), x, y)
    return Foothold(not support.left, px, py, support.yaw + yaw)


@compiled
def equal(one: Foothold, other: Foothold) -> bool:
    """Return whether two footholds are exactly equal."""
    return one.left == other.left and one.x == other.x and one.y == other.y and one.yaw == other.yaw


@compiled
def landing_of(support: Foothold, strides: Strides) -> Foothold:
    """Return the next foothold of the swing foot."""
    placement = strides.right if support.left else strides.left
    return placed(support, placement.x, placement.y, placement.yaw)


@compiled
def is_parallel(support: Foothold, other: Foothold, robot: Model) -> bool:
    """Return whether the stance is parallel within tolerance.

    After an early touchdown or a capture step the foot is off its planned landing, with the
    pendulum at rest: another footstep would start it again from an infeasible state.
    """
    parallel, near = landing_of(support, robot.still), STANCE_TOLERANCE * robot.gait.half_stance
    return (
        abs(other.x - parallel.x) < near
        and abs(other.y - parallel.y) < near
        and abs(other.yaw - parallel.yaw) < STANCE_YAW_TOLERANCE
    )


@compiled
def is_close(one: Foothold, other: Foothold, robot: Model) -> bool:
    """Return whether two footholds of a foot are equal within tolerance."""
    near = POSITION_TOLERANCE * robot.gait.half_stance
    return (
        abs(one.x - other.x) < near
        and abs(one.y - other.y) < near
        and abs(one.yaw - other.yaw) < YAW_TOLERANCE
    )


# Strides


@compiled
def stance_after(dx: float, dy: float, yaw: float, stance: float) -> Point:
    """Return the landing for a middle of the stance that moves along the chord of the arc.

    Args:
        dx: motion of the middle, forward [m].
        dy: motion of the middle, to the left [m].
        yaw: change of yaw [rad].
        stance: lateral distance of the foot from the middle after the turn [m].

    Returns:
        x, y in the frame of the support foot [m].
    """
    ch, sh = cos(0.5 * yaw), sin(0.5 * yaw)
    return (
        ch * dx - sh * dy - stance * sin(yaw),
        stance + sh * dx + ch * dy + stance * cos(yaw),
    )


@compiled
def clear_of(y: float, yaw: float, side: float, gap: float, sole: Sole) -> float:
    """Return the lateral landing with every corner clear of the strip of the support foot.

    Args:
        y: wanted landing [m].
        yaw: yaw of the landing [rad].
        side: side of the swing foot.
        gap: clearance [m].
        sole: rectangle of a sole.
    """
    heel, toe = sole.centre - sole.half_length, sole.centre + sole.half_length
    s = side * sin(yaw)
    inner = min(s * heel, s * toe) - sole.half_width * cos(yaw)
    min_distance = sole.half_width + gap - inner
    return side * max(side * y, min_distance)


@compiled
def within_reach(x: float, y: float, side: float, robot: Model) -> Point:
    """Scale a landing in the frame of the support foot into the ellipse of reach [m]."""
    limits = robot.limits
    centre = side * 2.0 * robot.gait.half_stance
    along, across = x / limits.reach_forward, (y - centre) / limits.reach_side
    square = along * along + across * across
    if square > 1.0:
        scale = 1.0 / sqrt(square)
        return x * scale, centre + (y - centre) * scale
    return x, y


@compiled
def velocity_strides(strides: Strides, velocity: Vector, time: float, robot: Model) -> int:
    """Set the strides of a velocity; return the limits that bind.

    Args:
        strides: strides to set.
        velocity: velocity of the middle of the stance (vx, vy, wz) [m/s, m/s, rad/s].
        time: duration of a footstep [s].
        robot: constants of the walk.
    """
    (vx, vy, wz), limits, bound = velocity, robot.limits, 0
    if abs(vx) * time > limits.step_forward:
        bound |= STEP_LENGTH
    if 2.0 * abs(vy) * time > limits.step_side:
        bound |= STEP_SIDE
    if 2.0 * abs(wz) * time > limits.step_turn:
        bound |= STEP_TURN
    for side in (RIGHT, LEFT):
        x, y, yaw = _opened(velocity, time, side, robot)
        clear = clear_of(y, yaw, side, robot.gait.foot_clearance, robot.sole)
        _put_stride(strides, side, x, clear, yaw)
        if clear != y:
            bound |= CLEARANCE
    return bound


@compiled
def _put_stride(strides: Strides, side: float, x: float, y: float, yaw: float) -> None:
    put(strides.right if side == RIGHT else strides.left, Foothold(side == LEFT, x, y, yaw))


@compiled
def _opened(velocity: Vector, time: float, side: float, robot: Model) -> Vector:
    """Return the landing on a side; it opens the stance if the motion is to that side."""
    limits, (vx, vy, wz) = robot.limits, velocity
    dx = clamp(vx * time, limits.step_forward)
    dy = clamp(2.0 * vy * time if vy * side > 0.0 else 0.0, limits.step_side)
    yaw = clamp(2.0 * wz * time if wz * side > 0.0 else 0.0, limits.step_turn)
    x, y = stance_after(dx, dy, yaw, side * robot.gait.half_stance)
    return x, y, yaw


@compiled
def command_strides(strides: Strides, command: StepCommand, turn: float, robot: Model) -> int:
    """Set the strides of a command state and a `turn` [rad]; return the limits that bind."""
    limits, gap, bound = robot.limits, robot.gait.foot_clearance, 0
    forward, lateral, direction = command.forward, command.side, command.direction
    dx = clamp(forward, limits.step_forward)
    apart = min(2.0 * robot.gait.half_stance + limits.step_side, lateral)
    yaw = clamp(direction + turn, limits.step_turn)
    if dx != forward:
        bound |= STEP_LENGTH
    if apart != lateral:
        bound |= STEP_SIDE
    if abs(direction) > limits.step_turn:
        bound |= STEP_TURN
    for side in (RIGHT, LEFT):
        x, y = stance_after(dx, 0.0, yaw, 0.5 * side * apart)
        clear = clear_of(y, yaw, side, gap, robot.sole)
        if clear != y:
            bound |= CLEARANCE
        rx, ry = within_reach(x, clear, side, robot)
        if rx != x or ry != clear:
            bound |= REACH
        _put_stride(strides, side, rx, clear_of(ry, yaw, side, gap, robot.sole), yaw)
    return bound


@compiled
def command_of(strides: Strides, timing: Timing) -> StepValues:
    """Return the command state of strides and timing, inverse of `command_strides`."""
    placement = strides.left
    forward, lateral = rotate_back(0.5 * placement.yaw, placement.x, placement.y)
    return (
        timing.single * CONTROL_PERIOD,
        timing.double * CONTROL_PERIOD,
        forward,
        lateral / cos(0.5 * placement.yaw),
        placement.yaw,
        timing.swing_height,
    )


@compiled
def mean_velocity(strides: Strides, time: float, robot: Model) -> Vector:
    """Return the mean velocity of strides of duration `time` [s], inverse of `velocity_strides`."""
    vx = vy = wz = 0.0
    for side in (RIGHT, LEFT):
        stance = side * robot.gait.half_stance
        placement = strides.right if side == RIGHT else strides.left
        dx = placement.x + stance * sin(placement.yaw)
        dy = placement.y - stance - stance * cos(placement.yaw)
        along, across = rotate_back(0.5 * placement.yaw, dx, dy)
        vx += along
        vy += across
        wz += placement.yaw
    return vx / (2.0 * time), vy / (2.0 * time), wz / (2.0 * time)


@compiled
def towards_strides(strides: Strides, one: Strides, other: Strides, fraction: float) -> None:
    """Set strides between two others, interpolated linearly."""
    put(strides.right, towards(foothold(one.right), foothold(other.right), fraction))
    put(strides.left, towards(foothold(one.left), foothold(other.left), fraction))


@compiled
def equal_strides(one: Strides, other: Strides) -> bool:
    """Return whether strides are exactly equal."""
    return equal(foothold(one.right), foothold(other.right)) and equal(
        foothold(one.left), foothold(other.left)
    )


@compiled
def reachable(support: Foothold, landing: Foothold, dx: float, dy: float, robot: Model) -> Foothold:
    """Shift a landing by dx, dy [m], within reach and clear of the support foot."""
    side = LEFT if landing.left else RIGHT
    wx, wy = landing.x + dx - support.x, landing.y + dy - support.y
    ahead, across = rotate_back(support.yaw, wx, wy)
    x, y = within_reach(ahead, across, side, robot)
    yaw = landing.yaw - support.yaw
    clear = clear_of(y, yaw, side, robot.gait.capture_clearance, robot.sole)
    return placed(support, x, clear, yaw)


@compiled
def tendency(velocity: Vector, robot: Model) -> float:
    """Return the motion across the stance: positive if the left foot opens it, zero for none."""
    _, vy, wz = velocity
    return vy / robot.limits.vy + wz / robot.limits.wz
