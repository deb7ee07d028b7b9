"""Plan of the walk: footholds, and the ZMP reference that they give."""

from compilation import compiled
from compilation.record import Records
from walking.data import Plan, Ramp
from walking.model import LEFT, RIGHT, Model, Strides
from walking.plan.footsteps import Foothold, foothold, is_parallel, landing_of, put
from walking.plan.gait import (
    phase_of,
    scheduled_zmp,
    stop_ticks,
    support_foot,
    swing_foot,
    zmp_between,
    zmp_under,
)
from walking.plane import Point


@compiled
def plan_walk(
    plan: Plan, landing: Foothold, following: Strides, moving: bool, robot: Model
) -> None:
    """Set footholds and ZMP reference of a plan from now on.

    Args:
        plan: plan whose gait is read; the rest is set.
        landing: foothold of the swing foot.
        following: strides of the footsteps after it.
        moving: whether the walk goes on; if not, it ends as soon as the stance is parallel.
        robot: constants.
    """
    gait, ramps = plan.gait, plan.ramps
    put(plan.steps[0], landing)
    plan.following, plan.moving = following, moving
    if gait.stepping:
        ends = _chain_footholds(plan, robot)
        _set_ramps(plan, ends, robot)
        return
    left, right = foothold(gait.footholds[LEFT]), foothold(gait.footholds[RIGHT])
    zmp, centre = scheduled_zmp(gait, robot), zmp_between(left, right, robot)
    set_ramp(
        ramps[0], max(1, -phase_of(gait).elapsed), zmp, centre, support_foot(gait), swing_foot(gait)
    )
    plan.ramp_count, plan.step_count = 1, 0


@compiled
def _chain_footholds(plan: Plan, robot: Model) -> bool:
    """Set the footholds, that of the swing foot first; return whether the walk ends with them."""
    steps, before, last = plan.steps, support_foot(plan.gait), foothold(plan.steps[0])
    for k in range(len(steps)):
        put(steps[k], last)
        plan.step_count = k + 1
        if k + 1 < len(steps) and not plan.moving and is_parallel(before, last, robot):
            return True
        before, last = last, landing_of(last, plan.following)
    return False


@compiled
def _set_ramps(plan: Plan, ends: bool, robot: Model) -> None:
    """Set the reference; it ends with equal loads after the last foothold if the walk `ends`."""
    gait, ramps, timing, row = plan.gait, plan.ramps, plan.gait.clock.timing, 0
    before, phase = support_foot(gait), phase_of(gait)
    left = phase.ticks_left
    px, py = zmp_under(before, robot)
    if phase.double:
        zmp, left = scheduled_zmp(gait, robot), gait.clock.single.ticks
        set_ramp(ramps[row], -phase.elapsed, zmp, (px, py), swing_foot(gait), before)
        row += 1
    set_ramp(ramps[row], left, (px, py), (px, py), before, before)
    row += 1
    for k in range(plan.step_count):
        step = foothold(plan.steps[k])
        x, y = zmp_under(step, robot)
        if ends and k == plan.step_count - 1:
            centre = zmp_between(before, step, robot)
            set_ramp(ramps[row], stop_ticks(robot), (px, py), centre, before, step)
            row += 1
        else:
            set_ramp(ramps[row], timing.double, (px, py), (x, y), before, step)
            set_ramp(ramps[row + 1], timing.single, (x, y), (x, y), step, step)
            row += 2
        before, px, py = step, x, y
    plan.ramp_count = row


@compiled
def reference_of(plan: Plan) -> Records[Ramp]:
    """Return the ramps of a plan from now on, see `Ramp` (n,)."""
    return plan.ramps[: plan.ramp_count]


@compiled
def set_ramp(
    ramp: Ramp, ticks: int, start: Point, end: Point, unloading: Foothold, loading: Foothold
) -> None:
    """Set a ramp of the ZMP from `start` to `end` [m]."""
    ramp.ticks = ticks
    ramp.ax, ramp.ay = start
    ramp.bx, ramp.by = end
    put(ramp.unloading, unloading)
    put(ramp.loading, loading)


@compiled
def is_single(ramp: Ramp) -> bool:
    """Whether a ramp is a single support."""
    return ramp.unloading.left == ramp.loading.left
