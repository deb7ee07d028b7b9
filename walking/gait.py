"""Gait: sequence of double and single supports, landing of the swing foot, and ZMP reference.

Feet are indexed 0 left, 1 right. A footstep is a double support, in which the ZMP moves onto the
support foot, and a single support, in which the other foot swings. The plan frame is that of the
first stance. Times are control ticks.
"""

from compilation import compiled
from walking.foothold import Foothold, foothold, put
from walking.footsteps import is_parallel, landing_of
from walking.parameters import CONTROL_PERIOD
from walking.plane import Point, clamp
from walking.records import Record
from walking.reference import (
    chain_footholds,
    reference_ramps,
    set_ramp,
    zmp_between,
    zmp_under,
)
from walking.swing import NO_FOOT, min_swing_ticks, move_feet, moved, rest_at

NO_STEPS = 0


# Clock


@compiled
def ticks_of(time: float) -> int:
    """Return the control ticks nearest to a time [s]."""
    return round(time / CONTROL_PERIOD)


@compiled
def put_single_support(single: Record, ticks: int, robot: Record) -> None:
    """Set a single support of a duration in control ticks."""
    gait = robot.gait
    single.ticks, single.origin = ticks, 0.0
    single.first, single.last = round(gait.swing_start * ticks), round(gait.swing_end * ticks)


@compiled
def phase_of(single: Record, elapsed: int) -> float:
    """Return the phase of the swing, 0 before and 1 after it [1]."""
    fraction = (elapsed - single.first) / (single.last - single.first)
    phase = single.origin + (1.0 - single.origin) * fraction
    clipped: float = 0.0 if phase < 0.0 else 1.0 if phase > 1.0 else phase
    return clipped


@compiled
def retime_single_support(single: Record, elapsed: int, ticks: int, robot: Record) -> None:
    """Change the total duration of a single support that began `elapsed` ticks ago.

    The swing continues from its present phase, and takes at least the minimum ticks.
    """
    gait, phase = robot.gait, phase_of(single, elapsed)
    min_ticks = ticks_of(gait.min_swing_time)
    while round(gait.swing_end * ticks) < elapsed + min_ticks:
        ticks += 1
    put_single_support(single, ticks, robot)
    if phase > 0.0 or elapsed > single.first:
        single.first, single.origin = elapsed, phase


@compiled
def shift_fraction(shift: Record, tick: int) -> float:
    """Return the progress of a weight shift at a tick [1]."""
    fraction: float = min(1.0, (tick - shift.begin) / (shift.end - shift.begin))
    return fraction


@compiled
def put_shift(shift: Record, begin: int, end: int, zmp: Point, right_weight: float) -> None:
    """Set a weight shift that begins with a ZMP [m] and a load fraction of the right foot [1]."""
    shift.begin, shift.end, shift.right_weight = begin, end, right_weight
    shift.zmp_x, shift.zmp_y = zmp


@compiled
def equal_clocks(one: Record, other: Record) -> bool:
    """Whether two clocks are the same number by number."""
    a, b, s, t = one.timing, other.timing, one.shift, other.shift
    u, v = one.single, other.single
    equal: bool = (
        a.double == b.double
        and a.single == b.single
        and a.swing_height == b.swing_height
        and s.begin == t.begin
        and s.end == t.end
        and s.zmp_x == t.zmp_x
        and s.zmp_y == t.zmp_y
        and s.right_weight == t.right_weight
        and u.ticks == v.ticks
        and u.first == v.first
        and u.last == v.last
        and u.origin == v.origin
    )
    return equal


@compiled
def update_phase(gait: Record, robot: Record) -> None:
    """Update the phase after a change of clock, tick or `landed_early`."""
    shift, single, stepping = gait.clock.shift, gait.clock.single, gait.stepping
    elapsed = gait.tick - shift.end
    gait.elapsed = elapsed
    gait.double = not stepping or elapsed < 0
    goal = float(gait.support) if stepping else 0.5
    weight = shift.right_weight
    gait.right_weight = weight + shift_fraction(shift, gait.tick) * (goal - weight)
    gait.ticks_left = single.ticks - elapsed
    gait.swing_phase = phase_of(single, elapsed) if stepping else 1.0
    freeze = robot.gait.landing_freeze
    gait.adjustable = stepping and not gait.landed_early and gait.swing_phase < freeze


# Feet


@compiled
def swing_of(gait: Record) -> int:
    """Return the index of the swing foot of this footstep."""
    swing: int = 1 - gait.support
    return swing


@compiled
def support_foot(gait: Record) -> Foothold:
    """Return the support foot of this footstep."""
    return foothold(gait.footholds[gait.support])


@compiled
def swing_foot(gait: Record) -> Foothold:
    """Return the last foothold of the swing foot."""
    return foothold(gait.footholds[swing_of(gait)])


@compiled
def is_airborne(gait: Record) -> bool:
    """Whether the swing foot is in the air."""
    airborne: bool = (
        gait.stepping and not gait.landed_early and not gait.double and 0.0 < gait.swing_phase < 1.0
    )
    return airborne


@compiled
def scheduled_zmp(gait: Record, robot: Record) -> Point:
    """Return the scheduled ZMP [m]."""
    if gait.stepping:
        x, y = zmp_under(support_foot(gait), robot)
    else:
        left, right = foothold(gait.footholds[0]), foothold(gait.footholds[1])
        x, y = zmp_between(left, right, robot)
    shift = gait.clock.shift
    fraction = shift_fraction(shift, gait.tick)
    return (
        shift.zmp_x + fraction * (x - shift.zmp_x),
        shift.zmp_y + fraction * (y - shift.zmp_y),
    )


# Changes of the gait


@compiled
def stand(gait: Record, robot: Record) -> None:
    """Begin to stand on the footholds, with the usual timing in `gait.clock.timing`."""
    left, right = foothold(gait.footholds[0]), foothold(gait.footholds[1])
    gait.tick = stop_ticks(robot)
    put_shift(gait.clock.shift, 0, gait.tick, zmp_between(left, right, robot), 0.5)
    put_single_support(gait.clock.single, gait.clock.timing.single, robot)
    gait.shift_fixed = True
    gait.swing_height = gait.clock.timing.swing_height
    put(gait.landing, right)
    update_phase(gait, robot)


@compiled
def stop_ticks(robot: Record) -> int:
    """Return the control ticks of the last double support."""
    return max(1, ticks_of(robot.gait.stop_time))


@compiled
def start(gait: Record, support: int, at_once: bool, robot: Record) -> None:
    """Start to walk.

    Args:
        gait: changed.
        support: index of the first support foot.
        at_once: whether to skip the long first double support.
        robot: constants.
    """
    ticks = max(1, ticks_of(robot.gait.start_time))
    if at_once:
        ticks = gait.clock.timing.double
    zmp, weight = scheduled_zmp(gait, robot), gait.right_weight
    _begin(gait, support, ticks, zmp, weight, robot)
    gait.shift_fixed = not at_once


@compiled
def _begin(
    gait: Record, support: int, double: int, zmp: Point, right_weight: float, robot: Record
) -> None:
    gait.stepping, gait.support = True, support
    gait.landed_early = gait.shortened = gait.shift_fixed = False
    gait.tick = 0
    put_shift(gait.clock.shift, 0, double, zmp, right_weight)
    put_single_support(gait.clock.single, gait.clock.timing.single, robot)
    update_phase(gait, robot)
    gait.swing_height = gait.clock.timing.swing_height
    put(gait.landing, landing_of(support_foot(gait), robot.still))


@compiled
def retime(gait: Record, timing: Record, robot: Record) -> bool:
    """Change the timing as far as the present footstep allows.

    A double support ends in the next tick at the earliest, a foot in the air takes at least
    `min_swing_time`, and the timing is frozen with the landing.

    Returns:
        whether the present footstep has the timing, too.
    """
    shift, single = gait.clock.shift, gait.clock.single
    free = gait.stepping and not gait.shortened
    if free and gait.double:
        if not gait.shift_fixed and timing.double != shift.end:
            _shift_until(gait, max(timing.double, gait.tick + 1), robot)
        if timing.single != single.ticks:
            put_single_support(single, timing.single, robot)
    elif free and timing.single != single.ticks and gait.adjustable:
        retime_single_support(single, gait.elapsed, timing.single, robot)
    now = gait.clock.timing
    now.double, now.single = timing.double, timing.single
    now.swing_height = timing.swing_height
    update_phase(gait, robot)
    if not free:
        return not gait.stepping
    timed: bool = shift.end == timing.double if gait.double else single.ticks == timing.single
    return timed


@compiled
def shorten(gait: Record, feet: Record, ticks: int, landing: Foothold, robot: Record) -> bool:
    """Shorten the footstep for a capture step.

    Args:
        gait: changed.
        feet: references of the feet.
        ticks: wanted ticks until the end of single support, as far as the foot can be down by then.
        landing: foothold of the swing foot.
        robot: constants.

    Returns:
        whether the footstep ends earlier.
    """
    p, before, elapsed = robot.gait, gait.ticks_left, gait.elapsed
    if ticks >= before or gait.shift_fixed or not gait.adjustable:
        return False
    swing_ticks = min_swing_ticks(feet[swing_of(gait)], landing, p.swing_speed)
    min_single, single = ticks_of(p.capture_single), gait.clock.single
    if gait.double:
        swing_ticks = max(swing_ticks, min_single)
        double = min(-elapsed, max(ticks_of(p.capture_double), ticks - swing_ticks))
        duration = max(swing_ticks, ticks - double)
        if double + duration >= before:
            return False
        _shift_until(gait, gait.tick + double, robot)
        put_single_support(single, duration, robot)
    else:
        rest = round((1.0 - gait.swing_phase) * min_single)
        duration = elapsed + max(swing_ticks, ticks_of(p.min_swing_time), rest, ticks)
        if duration >= single.ticks:
            return False
        retime_single_support(single, elapsed, duration, robot)
    update_phase(gait, robot)
    gait.shortened = True
    shorter: bool = gait.ticks_left < before
    return shorter


@compiled
def _shift_until(gait: Record, end: int, robot: Record) -> None:
    """Give the present weight shift another end."""
    zmp = scheduled_zmp(gait, robot)
    put_shift(gait.clock.shift, gait.tick, end, zmp, gait.right_weight)


@compiled
def aimed(gait: Record, landing: Foothold, wanted: Foothold, robot: Record) -> Foothold:
    """Return a landing moved towards `wanted` by at most one tick's change."""
    if gait.swing_phase == 0.0:
        return wanted
    p = robot.gait
    shift, turn = p.landing_speed * CONTROL_PERIOD, p.landing_turn * CONTROL_PERIOD
    return moved(landing, wanted, shift, turn)


@compiled
def touch_down(gait: Record, feet: Record, robot: Record) -> None:
    """Stop the swing foot at an early touchdown."""
    swing = swing_of(gait)
    foot = feet[swing]
    gait.landed_early = True
    put(gait.landing, Foothold(swing == 0, foot.x, foot.y, foot.yaw))
    update_phase(gait, robot)


@compiled
def advance(plan: Record, feet: Record, robot: Record) -> None:
    """Move the feet by one tick and start the next footstep at the end of this one.

    Args:
        plan: plan in force, its gait is changed.
        feet: references of the feet, changed.
        robot: constants.
    """
    gait = plan.gait
    gait.tick += 1
    update_phase(gait, robot)
    single, swing = gait.clock.single, NO_FOOT
    if gait.stepping and not gait.landed_early and single.first < gait.elapsed <= single.last:
        swing = swing_of(gait)
        change = gait.clock.timing.swing_height - gait.swing_height
        gait.swing_height += clamp(change, robot.gait.swing_height_rate * CONTROL_PERIOD)
    move_feet(
        feet,
        robot.stabilizer.contact_decay,
        swing,
        foothold(gait.landing),
        single.last - gait.elapsed + 1,
        gait.swing_height,
        gait.swing_phase,
    )
    if gait.stepping and gait.ticks_left == 0:
        _land(plan, feet, robot)


@compiled
def _land(plan: Record, feet: Record, robot: Record) -> None:
    gait = plan.gait
    support, swing, landing = gait.support, swing_of(gait), foothold(gait.landing)
    put(gait.footholds[swing], landing)
    rest_at(feet[swing], landing)
    gait.completed += 1
    here = zmp_under(support_foot(gait), robot)
    if not plan.moving and is_parallel(support_foot(gait), landing, robot):
        gait.stepping, gait.tick = False, 0
        put_shift(gait.clock.shift, 0, stop_ticks(robot), here, float(support))
        update_phase(gait, robot)
        return
    _begin(gait, swing, gait.clock.timing.double, here, float(support), robot)
    if plan.step_count > 1:
        put(gait.landing, foothold(plan.steps[1]))


# Plan


@compiled
def plan_walk(
    plan: Record, landing: Foothold, following: Record, moving: bool, robot: Record
) -> None:
    """Set footholds and ZMP reference of a plan from now on.

    Args:
        plan: plan whose gait is read; all but its ZMP plan is set.
        landing: foothold of the swing foot.
        following: strides of the footsteps after it.
        moving: whether the walk goes on.
        robot: constants.
    """
    gait, ramps, steps = plan.gait, plan.ramps, plan.steps
    put(plan.landing, landing)
    plan.following, plan.moving = following, moving
    support, swing = support_foot(gait), swing_foot(gait)
    if not gait.stepping:
        left, right = foothold(gait.footholds[0]), foothold(gait.footholds[1])
        centre = zmp_between(left, right, robot)
        zmp = scheduled_zmp(gait, robot)
        set_ramp(ramps[0], max(1, -gait.elapsed), zmp, centre, support, swing)
        plan.ramp_count, plan.step_count = 1, NO_STEPS
        return
    timing, single = gait.clock.timing, gait.clock.single.ticks
    count, ends = chain_footholds(steps, support, landing, following, moving, robot)
    shift, carry, zmp = 0, gait.ticks_left, (0.0, 0.0)
    if gait.double:
        shift, carry, zmp = -gait.elapsed, single, scheduled_zmp(gait, robot)
    ticks = (shift, carry, timing.double, timing.single, stop_ticks(robot))
    plan.step_count = count
    plan.ramp_count = reference_ramps(ramps, swing, support, steps, count, ends, zmp, ticks, robot)


@compiled
def copy_plan(copy: Record, plan: Record) -> None:
    """Copy a plan, except for its ZMP plan."""
    copy.gait, copy.landing, copy.following = plan.gait, plan.landing, plan.following
    copy.moving, copy.ramp_count, copy.step_count = plan.moving, plan.ramp_count, plan.step_count
    for k in range(plan.ramp_count):
        copy.ramps[k] = plan.ramps[k]
    for k in range(plan.step_count):
        copy.steps[k] = plan.steps[k]
