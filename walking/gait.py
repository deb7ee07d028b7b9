"""Gait: sequence of double and single supports, and landing of the swing foot.

Feet are indexed 0 left, 1 right. A footstep is a double support, in which the ZMP moves onto the
support foot, and a single support, in which the other foot swings. The plan frame is that of the
first stance. Times are control ticks.
"""

from compilation import compiled
from compilation.record import record_type
from walking.footsteps import FOOTHOLD, Foothold, foothold, is_parallel, landing_of, put
from walking.parameters import CONTROL_PERIOD
from walking.plane import Point, clamp, from_frame
from walking.records import Record
from walking.swing import lift_profile, min_swing_ticks, move_foot, moved, rest_at
from walking.timing import (
    CLOCK,
    phase_of,
    put_shift,
    put_single_support,
    retime_single_support,
    shift_fraction,
    ticks_of,
)

GAIT = record_type(
    stepping=bool,
    support=int,
    completed=int,
    landed_early=bool,
    shortened=bool,
    shift_fixed=bool,
    footholds=(FOOTHOLD, 2),
    landing=FOOTHOLD,
    clock=CLOCK,
    tick=int,
    swing_height=float,
    # Of clock and tick, see `walking.gait.update_phase`.
    elapsed=int,
    double=bool,
    right_weight=float,
    ticks_left=int,
    swing_phase=float,
    adjustable=bool,
)
"""Gait, see `walking.gait`: whether a footstep is under way; index of the support foot; completed
footsteps; whether the swing foot touched down early, this is a capture step shorter than its
timing, and the weight shift must keep its timing; present or last foothold of each foot; landing of
the swing foot; clock, and ticks since the begin of the footstep; height of this swing [m]; then
ticks since the begin of single support, whether double support is planned, planned load fraction of
the right foot [1], ticks until the end of single support, phase of the swing [1], whether the
landing may change."""

# Clock


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
def zmp_under(foot: Foothold, robot: Record) -> Point:
    """Return the ZMP of single support on a foot [m]."""
    pattern = robot.pattern
    inward = -pattern.zmp_inward if foot.left else pattern.zmp_inward
    return from_frame(
        (foot.x, foot.y, foot.yaw), robot.support.centre + pattern.zmp_forward, inward
    )


@compiled
def zmp_between(one: Foothold, other: Foothold, robot: Record) -> Point:
    """Return the ZMP of equal loads on two feet [m]."""
    ax, ay = zmp_under(one, robot)
    bx, by = zmp_under(other, robot)
    return 0.5 * (ax + bx), 0.5 * (ay + by)


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
    gait.clock.timing = timing
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
def end_support(gait: Record, robot: Record) -> None:
    """End the single support with this tick."""
    gait.clock.single.ticks = gait.elapsed + 1
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
    single = gait.clock.single
    for side in range(2):
        feet[side].height *= robot.stabilizer.contact_decay
    if gait.stepping and not gait.landed_early and single.first < gait.elapsed <= single.last:
        change = gait.clock.timing.swing_height - gait.swing_height
        gait.swing_height += clamp(change, robot.gait.swing_height_rate * CONTROL_PERIOD)
        height = gait.swing_height * lift_profile(gait.swing_phase)
        ticks_left = single.last - gait.elapsed + 1
        move_foot(feet[swing_of(gait)], foothold(gait.landing), ticks_left, height)
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
