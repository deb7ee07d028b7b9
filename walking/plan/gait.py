"""Gait: sequence of double and single supports, and landing of the swing foot.

Feet are indexed 0 left, 1 right. A footstep is a double support, in which the ZMP moves onto the
support foot, and a single support, in which the other foot swings. The plan frame is that of the
first stance. Times are control ticks.
"""

from typing import NamedTuple

from compilation import compiled
from compilation.record import Records
from walking.data import FootReference, Gait, Plan, Timing
from walking.model import LEFT, RIGHT, Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import Foothold, foothold, is_parallel, landing_of, put
from walking.plan.swing import lift_foot, min_swing_ticks, move_foot, moved, rest_at
from walking.plan.timing import (
    put_shift,
    put_single_support,
    retime_single_support,
    shift_fraction,
    swing_phase,
    ticks_of,
)
from walking.plane import Point, clamp, from_frame

# Phase


class Phase(NamedTuple):
    """Phase of a gait.

    Attributes:
        double: whether double support is planned.
        elapsed: ticks since the begin of single support, negative before it [1].
        ticks_left: ticks until the end of single support [1].
        swing: phase of the swing, 0 before and 1 after it [1].
    """

    double: bool
    elapsed: int
    ticks_left: int
    swing: float


@compiled
def phase_of(gait: Gait) -> Phase:
    """Return the phase of a gait."""
    single, elapsed = gait.clock.single, gait.tick - gait.clock.shift.end
    swing = swing_phase(single, elapsed) if gait.stepping else 1.0
    return Phase(is_double(gait), elapsed, single.ticks - elapsed, swing)


@compiled
def is_double(gait: Gait) -> bool:
    """Whether double support is planned."""
    return not gait.stepping or gait.tick < gait.clock.shift.end


@compiled
def is_adjustable(gait: Gait, robot: Model) -> bool:
    """Whether the landing may change."""
    swing = phase_of(gait).swing
    return gait.stepping and not gait.landed_early and swing < robot.gait.landing_freeze


@compiled
def right_weight(gait: Gait) -> float:
    """Return the planned load fraction of the right foot [1]."""
    shift, goal = gait.clock.shift, float(gait.support) if gait.stepping else 0.5
    weight = shift.right_weight
    return weight + shift_fraction(shift, gait.tick) * (goal - weight)


# Feet


@compiled
def swing_of(gait: Gait) -> int:
    """Return the index of the swing foot of this footstep."""
    return 1 - gait.support


@compiled
def support_foot(gait: Gait) -> Foothold:
    """Return the support foot of this footstep."""
    return foothold(gait.footholds[gait.support])


@compiled
def swing_foot(gait: Gait) -> Foothold:
    """Return the last foothold of the swing foot."""
    return foothold(gait.footholds[swing_of(gait)])


@compiled
def is_airborne(gait: Gait) -> bool:
    """Whether the swing foot is in the air."""
    phase = phase_of(gait)
    return not gait.landed_early and not phase.double and 0.0 < phase.swing < 1.0


@compiled
def zmp_under(foot: Foothold, robot: Model) -> Point:
    """Return the ZMP of single support on a foot [m]."""
    pattern = robot.pattern
    inward = -pattern.zmp_inward if foot.left else pattern.zmp_inward
    return from_frame(
        (foot.x, foot.y, foot.yaw), robot.support.centre + pattern.zmp_forward, inward
    )


@compiled
def zmp_between(one: Foothold, other: Foothold, robot: Model) -> Point:
    """Return the ZMP of equal loads on two feet [m]."""
    ax, ay = zmp_under(one, robot)
    bx, by = zmp_under(other, robot)
    return 0.5 * (ax + bx), 0.5 * (ay + by)


@compiled
def scheduled_zmp(gait: Gait, robot: Model) -> Point:
    """Return the scheduled ZMP [m]."""
    if gait.stepping:
        x, y = zmp_under(support_foot(gait), robot)
    else:
        left, right = foothold(gait.footholds[LEFT]), foothold(gait.footholds[RIGHT])
        x, y = zmp_between(left, right, robot)
    shift = gait.clock.shift
    fraction = shift_fraction(shift, gait.tick)
    return (
        shift.zmp_x + fraction * (x - shift.zmp_x),
        shift.zmp_y + fraction * (y - shift.zmp_y),
    )


# Changes of the gait


@compiled
def stand(gait: Gait, robot: Model) -> None:
    """Begin to stand on the footholds, with the usual timing in `gait.clock.timing`."""
    left, right = foothold(gait.footholds[LEFT]), foothold(gait.footholds[RIGHT])
    gait.tick = stop_ticks(robot)
    put_shift(gait.clock.shift, 0, gait.tick, zmp_between(left, right, robot), 0.5)
    put_single_support(gait.clock.single, gait.clock.timing.single, robot)
    gait.shift_fixed = True
    gait.swing_height = gait.clock.timing.swing_height
    put(gait.landing, right)


@compiled
def stop_ticks(robot: Model) -> int:
    """Return the control ticks of the last double support."""
    return max(1, ticks_of(robot.gait.stop_time))


@compiled
def start(gait: Gait, support: int, at_once: bool, robot: Model) -> None:
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
    zmp, weight = scheduled_zmp(gait, robot), right_weight(gait)
    _begin(gait, support, ticks, zmp, weight, robot)
    gait.shift_fixed = not at_once


@compiled
def _begin(gait: Gait, support: int, double: int, zmp: Point, weight: float, robot: Model) -> None:
    gait.stepping, gait.support = True, support
    gait.landed_early = gait.shortened = gait.shift_fixed = False
    gait.tick = 0
    put_shift(gait.clock.shift, 0, double, zmp, weight)
    put_single_support(gait.clock.single, gait.clock.timing.single, robot)
    gait.swing_height = gait.clock.timing.swing_height
    put(gait.landing, landing_of(support_foot(gait), robot.still))


@compiled
def retime(gait: Gait, timing: Timing, robot: Model) -> bool:
    """Change the timing as far as the present footstep allows.

    A double support ends in the next tick at the earliest, a foot in the air takes at least
    `min_swing_time`, and the timing is frozen with the landing.

    Returns:
        whether the present footstep has the timing, too.
    """
    shift, single = gait.clock.shift, gait.clock.single
    free, phase = gait.stepping and not gait.shortened, phase_of(gait)
    if free and phase.double:
        if not gait.shift_fixed and timing.double != shift.end:
            _shift_until(gait, max(timing.double, gait.tick + 1), robot)
        if timing.single != single.ticks:
            put_single_support(single, timing.single, robot)
    elif free and timing.single != single.ticks and is_adjustable(gait, robot):
        retime_single_support(single, phase.elapsed, timing.single, robot)
    gait.clock.timing = timing
    if not free:
        return not gait.stepping
    return shift.end == timing.double if phase.double else single.ticks == timing.single


@compiled
def shorten(
    gait: Gait, feet: Records[FootReference], ticks: int, landing: Foothold, robot: Model
) -> bool:
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
    p, (double_now, elapsed, before, swing) = robot.gait, phase_of(gait)
    if ticks >= before or gait.shift_fixed or not is_adjustable(gait, robot):
        return False
    swing_ticks = min_swing_ticks(feet[swing_of(gait)], landing, p.swing_speed)
    min_single, single = ticks_of(p.capture_single), gait.clock.single
    if double_now:
        swing_ticks = max(swing_ticks, min_single)
        double = min(-elapsed, max(ticks_of(p.capture_double), ticks - swing_ticks))
        duration = max(swing_ticks, ticks - double)
        if double + duration >= before:
            return False
        _shift_until(gait, gait.tick + double, robot)
        put_single_support(single, duration, robot)
    else:
        rest = round((1.0 - swing) * min_single)
        duration = elapsed + max(swing_ticks, ticks_of(p.min_swing_time), rest, ticks)
        if duration >= single.ticks:
            return False
        retime_single_support(single, elapsed, duration, robot)
    gait.shortened = True
    return phase_of(gait).ticks_left < before


@compiled
def _shift_until(gait: Gait, end: int, robot: Model) -> None:
    """Give the present weight shift another end."""
    zmp = scheduled_zmp(gait, robot)
    put_shift(gait.clock.shift, gait.tick, end, zmp, right_weight(gait))


@compiled
def aimed(gait: Gait, landing: Foothold, wanted: Foothold, robot: Model) -> Foothold:
    """Return a landing moved towards `wanted` by at most one tick's change."""
    if phase_of(gait).swing == 0.0:
        return wanted
    p = robot.gait
    shift, turn = p.landing_speed * CONTROL_PERIOD, p.landing_turn * CONTROL_PERIOD
    return moved(landing, wanted, shift, turn)


@compiled
def touch_down(gait: Gait, feet: Records[FootReference], robot: Model) -> None:
    """Stop the swing foot at an early touchdown."""
    swing = swing_of(gait)
    foot = feet[swing]
    gait.landed_early = True
    put(gait.landing, Foothold(swing == LEFT, foot.x, foot.y, foot.yaw))


@compiled
def end_support(gait: Gait) -> None:
    """End the single support with this tick."""
    gait.clock.single.ticks = phase_of(gait).elapsed + 1


@compiled
def advance(plan: Plan, feet: Records[FootReference], robot: Model) -> None:
    """Move the feet by one tick and start the next footstep at the end of this one.

    Args:
        plan: plan in force, its gait is changed.
        feet: references of the feet, changed.
        robot: constants.
    """
    gait = plan.gait
    gait.tick += 1
    single, phase = gait.clock.single, phase_of(gait)
    swinging = gait.stepping and single.first < phase.elapsed <= single.last
    swinging = swinging and not gait.landed_early
    for side in range(2):
        if not swinging or side == gait.support:
            feet[side].height *= robot.stabilizer.contact_decay
    if swinging:
        foot, change = feet[swing_of(gait)], gait.clock.timing.swing_height - gait.swing_height
        gait.swing_height += clamp(change, robot.gait.swing_height_rate * CONTROL_PERIOD)
        ticks_left, before = single.last - phase.elapsed + 1, swing_phase(single, phase.elapsed - 1)
        move_foot(foot, foothold(gait.landing), ticks_left)
        lift_foot(foot, gait.swing_height, phase.swing, phase.swing - before, ticks_left)
    if gait.stepping and phase.ticks_left == 0:
        _land(plan, feet, robot)


@compiled
def _land(plan: Plan, feet: Records[FootReference], robot: Model) -> None:
    gait = plan.gait
    support, swing, landing = gait.support, swing_of(gait), foothold(gait.landing)
    put(gait.footholds[swing], landing)
    rest_at(feet[swing], landing)
    gait.completed += 1
    here = zmp_under(support_foot(gait), robot)
    if not plan.moving and is_parallel(support_foot(gait), landing, robot):
        gait.stepping, gait.tick = False, 0
        put_shift(gait.clock.shift, 0, stop_ticks(robot), here, float(support))
        return
    _begin(gait, swing, gait.clock.timing.double, here, float(support), robot)
    if plan.step_count > 1:
        put(gait.landing, foothold(plan.steps[1]))
