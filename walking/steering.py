"""Steering: commands become wanted strides and timing, within limits of speed and acceleration.

Velocity commands and command states may follow in any order.
"""

from math import sqrt

from compilation import compiled
from compilation.record import record_type
from walking.command import ACCELERATION, BALANCE, COMBINED_SPEED, SETTLING, SPEED
from walking.footsteps import (
    STILL,
    STRIDES,
    command_of,
    command_strides,
    stride_limits,
    velocity_strides,
)
from walking.mwpg import is_selected
from walking.parameters import CONTROL_PERIOD
from walking.plane import Vector, clamp
from walking.records import Record
from walking.timing import TIMING, cadence, command_timing, duration, put_timing

COMMAND = record_type(explicit=bool, values=(float, 6))
"""Velocity (vx, vy, wz), or the fields of a command state in order, see `walking.command`."""

STEERING = record_type(
    command=COMMAND,
    state=COMMAND,
    velocity=(float, 3),
    peak=(float, 3),
    timing=TIMING,
    wanted=STRIDES,
    scratch=STRIDES,
    bound=int,
)
"""Steering: present command; command state in force, if `explicit`; wanted velocity (vx, vy, wz)
[m/s, m/s, rad/s], and its last peak per axis; wanted timing and strides; strides for intermediate
results; limits that bind, as bits."""

SAME_SPEED = 1e-9  # rounding error of velocities [m/s, rad/s]


@compiled
def wanted_velocity(steering: Record) -> Vector:
    """Return the wanted velocity (vx, vy, wz) [m/s, m/s, rad/s]."""
    v = steering.velocity
    return v[0], v[1], v[2]


@compiled
def moves(steering: Record) -> bool:
    """Whether a motion is wanted."""
    v = steering.velocity
    moving: bool = steering.state.explicit or v[0] != 0.0 or v[1] != 0.0 or v[2] != 0.0
    return moving


@compiled
def limited(velocity: Vector, robot: Record) -> Vector:
    """Clip a velocity to the limits of each component and to the ellipsoid of all.

    Returns:
        (vx, vy, wz) [m/s, m/s, rad/s]; the direction of the command is kept when the ellipsoid
        binds.
    """
    limits = robot.limits
    vx, vy, wz = _within(velocity, robot)
    max_vx = limits.vx if vx >= 0.0 else limits.vx_backward
    x, y, turned = vx / max_vx, vy / limits.vy, wz / limits.wz
    size = sqrt(x * x + y * y + turned * turned)
    if size > limits.combined:
        scale = limits.combined / size
        return vx * scale, vy * scale, wz * scale
    return vx, vy, wz


@compiled
def speed_limits(velocity: Vector, robot: Record) -> int:
    """Return the speed limits that bind on a velocity command."""
    bound, within = 0, _within(velocity, robot)
    if within != velocity:
        bound |= SPEED
    if limited(velocity, robot) != within:
        bound |= COMBINED_SPEED
    return bound


@compiled
def _within(velocity: Vector, robot: Record) -> Vector:
    """Clip every component to its limit."""
    limits = robot.limits
    return (
        min(limits.vx, max(-limits.vx_backward, velocity[0])),
        clamp(velocity[1], limits.vy),
        clamp(velocity[2], limits.wz),
    )


@compiled
def follow_command(
    steering: Record, speed_ratio: float, settled: bool, balanced: bool, robot: Record
) -> None:
    """Follow the command of this tick.

    Args:
        steering: changed.
        speed_ratio: ratio of a velocity command to walk at [1].
        settled: whether the robot may start to move.
        balanced: whether the motion may change.
        robot: constants.
    """
    steering.bound = 0
    explicit, values = steering.command.explicit, steering.command.values
    velocity = (values[0], values[1], values[2])
    if not balanced:
        _hold(steering, robot)
    elif not settled:
        if explicit or velocity != STILL:
            steering.bound |= SETTLING
        _approach(steering, STILL, robot)
    elif explicit:
        _follow_state(steering, robot)
    else:
        _follow_velocity(steering, velocity, speed_ratio, robot)


@compiled
def use_next_timing(timing: Record, steering: Record, before: Record, stepping: bool) -> None:
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
def set_wanted_strides(steering: Record, correction: Vector, robot: Record) -> None:
    """Set the wanted strides.

    Args:
        steering: its wanted strides are set.
        correction: correction of the velocity (vx, vy, wz) [m/s, m/s, rad/s]; command states use
            only wz.
        robot: constants.
    """
    time = duration(steering.timing)
    if steering.state.explicit:
        command_strides(steering.wanted, steering.state.values, correction[2] * time, robot)
    else:
        vx, vy, wz = wanted_velocity(steering)
        velocity = (vx + correction[0], vy + correction[1], wz + correction[2])
        velocity_strides(steering.wanted, velocity, time, robot)


@compiled
def _hold(steering: Record, robot: Record) -> None:
    """Keep the present motion; balance limits any other command."""
    command, state = steering.command, steering.state
    if command.explicit:
        same = state.explicit
        for k in range(6):
            same = same and command.values[k] == state.values[k]
        if not same:
            steering.bound |= BALANCE
            return
        steering.bound |= command_strides(steering.scratch, command.values, 0.0, robot)
        steering.bound |= command_timing(command.values, robot)[1]
        return
    velocity = (command.values[0], command.values[1], command.values[2])
    if state.explicit or _differs(steering, limited(velocity, robot)):
        steering.bound |= BALANCE
    steering.bound |= speed_limits(velocity, robot)
    if not state.explicit:
        time, wanted = duration(steering.timing), wanted_velocity(steering)
        steering.bound |= stride_limits(steering.scratch, wanted, time, robot)


@compiled
def _differs(steering: Record, wanted: Vector) -> bool:
    """Whether a velocity differs from the wanted one; at rest any does."""
    vx, vy, wz = wanted_velocity(steering)
    if wanted == STILL:
        return vx != 0.0 or vy != 0.0 or wz != 0.0
    return (
        abs(vx - wanted[0]) > SAME_SPEED
        or abs(vy - wanted[1]) > SAME_SPEED
        or abs(wz - wanted[2]) > SAME_SPEED
    )


@compiled
def _follow_velocity(steering: Record, velocity: Vector, speed_ratio: float, robot: Record) -> None:
    steering.state.explicit = False
    wanted = velocity
    if speed_ratio < 1.0 and velocity != STILL:
        vx, vy, wz = limited(velocity, robot)
        wanted = (speed_ratio * vx, speed_ratio * vy, speed_ratio * wz)
        steering.bound |= BALANCE
    if is_selected(robot) and velocity == STILL:
        # This generator limits the change itself.
        _jump(steering, STILL)
    limit = _approach(steering, wanted, robot)
    steering.bound |= speed_limits(velocity, robot)
    now = wanted_velocity(steering)
    put_timing(steering.timing, cadence(now, robot))
    if _differs(steering, limit):
        steering.bound |= ACCELERATION
    time = duration(steering.timing)
    steering.bound |= stride_limits(steering.scratch, now, time, robot)


@compiled
def _follow_state(steering: Record, robot: Record) -> None:
    command = steering.command.values
    steering.state = steering.command
    timing, late = command_timing(command, robot)
    put_timing(steering.timing, timing)
    steering.bound |= command_strides(steering.scratch, command, 0.0, robot) | late
    time = duration(steering.timing)
    # A later velocity command starts from this velocity.
    start = command_of(steering.scratch, steering.timing)
    _jump(steering, (start[2] / time, 0.0, start[4] / time))


@compiled
def _jump(steering: Record, velocity: Vector) -> None:
    for k in range(3):
        steering.velocity[k] = velocity[k]


@compiled
def _approach(steering: Record, velocity: Vector, robot: Record) -> Vector:
    """Approach a velocity by one tick; return it within the speed limits."""
    limits, wanted = robot.limits, limited(velocity, robot)
    braking = CONTROL_PERIOD / limits.braking_time
    acceleration = (
        limits.forward_acceleration * CONTROL_PERIOD,
        limits.lateral_acceleration * CONTROL_PERIOD,
        limits.turn_acceleration * CONTROL_PERIOD,
    )
    for axis in range(3):
        steering.velocity[axis] = _rate_limited(
            steering.peak, axis, steering.velocity[axis], wanted[axis], acceleration[axis], braking
        )
    return wanted


@compiled
def _rate_limited(
    peak: Record, axis: int, now: float, wanted: float, acceleration: float, braking: float
) -> float:
    """Return a component a tick later; braking is a part of its last peak per tick [1]."""
    change = wanted - now
    if now * change >= 0.0:
        peak[axis] = abs(now)
        return now + clamp(change, acceleration)
    peak[axis] = max(peak[axis], abs(now))
    step = max(acceleration, braking * peak[axis])
    if abs(now) < min(step, abs(change)):
        return 0.0  # a reversal passes through rest
    return now + clamp(change, step)
