"""Steering: commands become wanted strides and timing, within limits of speed and acceleration.

Velocity commands and command states may follow in any order.
"""

from math import sqrt

from compilation import compiled
from walking.command import ACCELERATION, BALANCE, COMBINED_SPEED, SETTLING, SPEED
from walking.data import CommandRecord, Steering, StepCommand, Timing, Twist
from walking.model import Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import (
    STILL,
    StepValues,
    command_of,
    command_strides,
    velocity_strides,
)
from walking.plan.timing import cadence, command_timing, duration, put_timing
from walking.plane import Point, Vector, clamp, within

SAME_SPEED = 1e-9  # rounding error of velocities [m/s, rad/s]


@compiled
def twist_of(record: Twist) -> Vector:
    """Return the value of a record (vx, vy, wz) [m/s, m/s, rad/s]."""
    return record.vx, record.vy, record.wz


@compiled
def put_twist(record: Twist, velocity: Vector) -> None:
    """Set a record."""
    record.vx, record.vy, record.wz = velocity


@compiled
def put_command(record: CommandRecord, command: StepValues, explicit: bool) -> None:
    """Set a record to a velocity (vx, vy, wz), or to an explicit footstep."""
    record.explicit, step = explicit, record.step
    if explicit:
        step.single_support, step.double_support, step.forward = command[:3]
        step.side, step.direction, step.swing_height = command[3:]
    else:
        put_twist(record.velocity, command[:3])


@compiled
def step_values(record: StepCommand) -> StepValues:
    """Return the fields of an explicit footstep in order."""
    return (
        record.single_support,
        record.double_support,
        record.forward,
        record.side,
        record.direction,
        record.swing_height,
    )


@compiled
def moves(steering: Steering) -> bool:
    """Whether a motion is wanted."""
    return steering.state.explicit or twist_of(steering.velocity) != STILL


@compiled
def limited(velocity: Vector, robot: Model) -> tuple[Vector, int]:
    """Clip a velocity to the limits of each component and to the ellipsoid of all.

    Returns:
        (vx, vy, wz) [m/s, m/s, rad/s]; the direction of the command is kept when the ellipsoid
        binds; limits that bind.
    """
    limits, (vx, vy, wz) = robot.limits, velocity
    vx = within(vx, -limits.vx_backward, limits.vx)
    vy, wz = clamp(vy, limits.vy), clamp(wz, limits.wz)
    bound = SPEED if (vx, vy, wz) != velocity else 0
    max_vx = limits.vx if vx >= 0.0 else limits.vx_backward
    x, y, turn = vx / max_vx, vy / limits.vy, wz / limits.wz
    size = sqrt(x * x + y * y + turn * turn)
    if size > limits.combined:
        scale = limits.combined / size
        return (vx * scale, vy * scale, wz * scale), bound | COMBINED_SPEED
    return (vx, vy, wz), bound


@compiled
def follow_command(
    steering: Steering, speed_ratio: float, settled: bool, balanced: bool, robot: Model
) -> int:
    """Follow the command of this tick; return the limits that bind.

    Args:
        steering: changed.
        speed_ratio: ratio of a velocity command to walk at [1].
        settled: whether the robot may start to move.
        balanced: whether the motion may change.
        robot: constants.
    """
    explicit, velocity = steering.command.explicit, twist_of(steering.command.velocity)
    if not balanced:
        return _hold(steering, robot)
    if not settled:
        _approach(steering, STILL, robot)
        return SETTLING if explicit or velocity != STILL else 0
    if explicit:
        return _follow_state(steering, robot)
    return _follow_velocity(steering, velocity, speed_ratio, robot)


@compiled
def use_next_timing(timing: Timing, steering: Steering, before: Timing, stepping: bool) -> None:
    """Set the timing of the next footsteps.

    Footsteps that close the stance are at least as fast as the walk was: during a slow footstep the
    moving body would go too far.

    Args:
        timing: set.
        steering: steering of the walk.
        before: timing of the present footstep.
        stepping: whether a footstep is under way.
    """
    faster = stepping and not moves(steering) and duration(before) < duration(steering.timing)
    wanted = before if faster else steering.timing
    timing.double, timing.single = wanted.double, wanted.single
    timing.swing_height = wanted.swing_height


@compiled
def set_wanted_strides(steering: Steering, correction: Vector, robot: Model) -> None:
    """Set the wanted strides.

    Args:
        steering: its wanted strides are set.
        correction: correction of the velocity (vx, vy, wz) [m/s, m/s, rad/s]; command states use
            only wz.
        robot: constants.
    """
    time, (dx, dy, turn) = duration(steering.timing), correction
    if steering.state.explicit:
        command_strides(steering.wanted, steering.state.step, turn * time, robot)
    else:
        vx, vy, wz = twist_of(steering.velocity)
        velocity_strides(steering.wanted, (vx + dx, vy + dy, wz + turn), time, robot)


@compiled
def _hold(steering: Steering, robot: Model) -> int:
    """Keep the present motion; balance limits any other command."""
    command, state = steering.command, steering.state
    if command.explicit:
        if not (state.explicit and step_values(command.step) == step_values(state.step)):
            return BALANCE
        _, late = command_timing(command.step, robot)
        return command_strides(steering.scratch, command.step, 0.0, robot) | late
    velocity = twist_of(command.velocity)
    limit, bound = limited(velocity, robot)
    if state.explicit or _differs(steering, limit):
        bound |= BALANCE
    if not state.explicit:
        time, wanted = duration(steering.timing), twist_of(steering.velocity)
        bound |= velocity_strides(steering.scratch, wanted, time, robot)
    return bound


@compiled
def _differs(steering: Steering, wanted: Vector) -> bool:
    """Whether a velocity differs from the wanted one; at rest any does."""
    (vx, vy, wz), (x, y, turn) = twist_of(steering.velocity), wanted
    if wanted == STILL:
        return vx != 0.0 or vy != 0.0 or wz != 0.0
    return abs(vx - x) > SAME_SPEED or abs(vy - y) > SAME_SPEED or abs(wz - turn) > SAME_SPEED


@compiled
def _follow_velocity(steering: Steering, velocity: Vector, speed_ratio: float, robot: Model) -> int:
    steering.state.explicit = False
    (vx, vy, wz), bound = limited(velocity, robot)
    wanted = velocity
    if speed_ratio < 1.0 and velocity != STILL:
        wanted = (speed_ratio * vx, speed_ratio * vy, speed_ratio * wz)
        bound |= BALANCE
    if robot.modifiable and velocity == STILL:
        # This generator limits the change itself.
        put_twist(steering.velocity, STILL)
    limit = _approach(steering, wanted, robot)
    now = twist_of(steering.velocity)
    put_timing(steering.timing, cadence(now, robot))
    if _differs(steering, limit):
        bound |= ACCELERATION
    return bound | velocity_strides(steering.scratch, now, duration(steering.timing), robot)


@compiled
def _follow_state(steering: Steering, robot: Model) -> int:
    command = steering.command.step
    steering.state = steering.command
    timing, late = command_timing(command, robot)
    put_timing(steering.timing, timing)
    bound = command_strides(steering.scratch, command, 0.0, robot)
    time = duration(steering.timing)
    # A later velocity command starts from this velocity.
    _, _, forward, _, direction, _ = command_of(steering.scratch, steering.timing)
    put_twist(steering.velocity, (forward / time, 0.0, direction / time))
    return bound | late


@compiled
def _approach(steering: Steering, velocity: Vector, robot: Model) -> Vector:
    """Approach a velocity by one tick; return it within the speed limits."""
    limits, (wanted, _) = robot.limits, limited(velocity, robot)
    braking = CONTROL_PERIOD / limits.braking_time
    now, peak, (vx, vy, wz) = steering.velocity, steering.peak, wanted
    forward = limits.forward_acceleration * CONTROL_PERIOD
    now.vx, peak.vx = _rate_limited(now.vx, peak.vx, vx, forward, braking)
    lateral = limits.lateral_acceleration * CONTROL_PERIOD
    now.vy, peak.vy = _rate_limited(now.vy, peak.vy, vy, lateral, braking)
    turn = limits.turn_acceleration * CONTROL_PERIOD
    now.wz, peak.wz = _rate_limited(now.wz, peak.wz, wz, turn, braking)
    return wanted


@compiled
def _rate_limited(
    now: float, peak: float, wanted: float, acceleration: float, braking: float
) -> Point:
    """Return a component and its last peak a tick later; braking is a part of the peak [1]."""
    change = wanted - now
    if now * change >= 0.0:
        return now + clamp(change, acceleration), abs(now)
    peak = max(peak, abs(now))
    step = max(acceleration, braking * peak)
    if abs(now) < min(step, abs(change)):
        return 0.0, peak  # a reversal passes through rest
    return now + clamp(change, step), peak
