"""Timing of footsteps in control ticks: double and single supports, and the clock of one.

A footstep is a double support, in which ZMP and weight shift to the support foot, and a single
support, in which the other foot swings.
"""

from math import sqrt

from compilation import compiled
from walking.command import SWING_HEIGHT
from walking.command import TIMING as TIMING_LIMIT
from walking.data import Clock, SingleSupport, StepCommand, Timing, WeightShift
from walking.model import Model
from walking.parameters import CONTROL_PERIOD
from walking.plane import Point, Vector, within

StepTiming = tuple[int, int, float]
"""Control ticks in double and single support [1], swing height [m]."""


@compiled
def duration(timing: Timing) -> float:
    """Return the duration of a footstep [s]."""
    return (timing.double + timing.single) * CONTROL_PERIOD


@compiled
def cadence(velocity: Vector, robot: Model) -> StepTiming:
    """Return the timing for a velocity (vx, vy, wz) [m/s, m/s, rad/s].

    Footsteps that would exceed their limits are made faster instead.
    """
    gait, limits = robot.gait, robot.limits
    vx, vy, wz = velocity
    x, y = vx / limits.step_forward, 2.0 * vy / limits.step_side
    turn = 2.0 * wz / limits.step_turn
    rate = sqrt(x * x + y * y + turn * turn)
    time = max(gait.min_footstep_time, 1.0 / max(rate, 1.0 / gait.footstep_time))
    ticks = max(2, round(time / CONTROL_PERIOD))  # at least one of each support
    double = min(ticks - 1, max(1, round(gait.double_support * ticks)))
    return double, ticks - double, gait.swing_height


@compiled
def command_timing(command: StepCommand, robot: Model) -> tuple[StepTiming, int]:
    """Return the timing of a command state and the limits that bind."""
    limits, bound = robot.limits, 0
    single_support, double_support = command.single_support, command.double_support
    swing_height = command.swing_height
    double = within(double_support, CONTROL_PERIOD, limits.max_double)
    single = within(single_support, limits.min_single, limits.max_single)
    height = within(swing_height, 0.0, limits.max_swing_height)
    if double != double_support or single != single_support:
        bound |= TIMING_LIMIT
    if height != swing_height:
        bound |= SWING_HEIGHT
    return (round(double / CONTROL_PERIOD), round(single / CONTROL_PERIOD), height), bound


@compiled
def put_timing(record: Timing, timing: StepTiming) -> None:
    """Set a timing."""
    record.double, record.single, record.swing_height = timing


@compiled
def ticks_of(time: float) -> int:
    """Return the control ticks nearest to a time [s]."""
    return round(time / CONTROL_PERIOD)


@compiled
def put_single_support(single: SingleSupport, ticks: int, robot: Model) -> None:
    """Set a single support of a duration in control ticks."""
    gait = robot.gait
    single.ticks, single.origin = ticks, 0.0
    single.first, single.last = round(gait.swing_start * ticks), round(gait.swing_end * ticks)


@compiled
def swing_phase(single: SingleSupport, elapsed: int) -> float:
    """Return the phase of the swing, 0 before and 1 after it [1]."""
    fraction = (elapsed - single.first) / (single.last - single.first)
    phase = single.origin + (1.0 - single.origin) * fraction
    return within(phase, 0.0, 1.0)


@compiled
def retime_single_support(single: SingleSupport, elapsed: int, ticks: int, robot: Model) -> None:
    """Change the total duration of a single support that began `elapsed` ticks ago.

    The swing continues from its present phase, and takes at least the minimum ticks.
    """
    gait, phase = robot.gait, swing_phase(single, elapsed)
    min_ticks = ticks_of(gait.min_swing_time)
    while round(gait.swing_end * ticks) < elapsed + min_ticks:
        ticks += 1
    put_single_support(single, ticks, robot)
    if phase > 0.0 or elapsed > single.first:
        single.first, single.origin = elapsed, phase


@compiled
def shift_fraction(shift: WeightShift, tick: int) -> float:
    """Return the progress of a weight shift at a tick [1]."""
    return min(1.0, (tick - shift.begin) / (shift.end - shift.begin))


@compiled
def put_shift(shift: WeightShift, begin: int, end: int, zmp: Point, right_weight: float) -> None:
    """Set a weight shift that begins with a ZMP [m] and a load fraction of the right foot [1]."""
    shift.begin, shift.end, shift.right_weight = begin, end, right_weight
    shift.zmp_x, shift.zmp_y = zmp


@compiled
def equal_clocks(one: Clock, other: Clock) -> bool:
    """Whether this footstep and the next ones have the same times."""
    a, b = one.timing, other.timing
    return (
        a.double == b.double
        and a.single == b.single
        and a.swing_height == b.swing_height
        and one.shift.end == other.shift.end
        and one.single.ticks == other.single.ticks
    )
