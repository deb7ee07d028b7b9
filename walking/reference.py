"""Plan of the walk: footholds, and the ZMP reference that they give."""

from compilation import compiled
from compilation.record import record_type
from walking.footsteps import FOOTHOLD, STRIDES, Foothold, foothold, is_parallel, landing_of, put
from walking.gait import (
    GAIT,
    scheduled_zmp,
    stop_ticks,
    support_foot,
    swing_foot,
    zmp_between,
    zmp_under,
)
from walking.plane import Point
from walking.records import Record

RAMP = record_type(
    ticks=int,
    ax=float,
    ay=float,
    bx=float,
    by=float,
    unloading=FOOTHOLD,
    loading=FOOTHOLD,
)
"""Linear segment of the ZMP reference: control ticks; ZMP at its start and its end [m]; unloading
and loading foot, in single support twice the support foot."""

STEPS = 4  # planned footholds

PLAN = record_type(
    gait=GAIT,
    landing=FOOTHOLD,
    following=STRIDES,
    moving=bool,
    ramps=(RAMP, 2 * STEPS + 2),
    ramp_count=int,
    steps=(FOOTHOLD, STEPS),
    step_count=int,
)
"""Plan of the walk: gait with its timing; landing of the swing foot, strides after it, and whether
the walk goes on; ZMP reference and its number of ramps; footholds and their number."""

LIVE, WANTED, TRIAL, BEST = range(4)
"""Plans: the one in force, the wanted one, one that is tried, and the best that was admitted."""


@compiled
def plan_walk(
    plan: Record, landing: Foothold, following: Record, moving: bool, robot: Record
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
    put(plan.landing, landing)
    plan.following, plan.moving = following, moving
    if gait.stepping:
        ends = _chain_footholds(plan, robot)
        _set_ramps(plan, ends, robot)
        return
    left, right = foothold(gait.footholds[0]), foothold(gait.footholds[1])
    zmp, centre = scheduled_zmp(gait, robot), zmp_between(left, right, robot)
    set_ramp(ramps[0], max(1, -gait.elapsed), zmp, centre, support_foot(gait), swing_foot(gait))
    plan.ramp_count, plan.step_count = 1, 0


@compiled
def _chain_footholds(plan: Record, robot: Record) -> bool:
    """Set the footholds, that of the swing foot first; return whether the walk ends with them."""
    steps, before, last = plan.steps, support_foot(plan.gait), foothold(plan.landing)
    for k in range(len(steps)):
        put(steps[k], last)
        plan.step_count = k + 1
        if k + 1 < len(steps) and not plan.moving and is_parallel(before, last, robot):
            return True
        before, last = last, landing_of(last, plan.following)
    return False


@compiled
def _set_ramps(plan: Record, ends: bool, robot: Record) -> None:
    """Set the reference; it ends with equal loads after the last foothold if the walk `ends`."""
    gait, ramps, timing, row = plan.gait, plan.ramps, plan.gait.clock.timing, 0
    before, left = support_foot(gait), gait.ticks_left
    px, py = zmp_under(before, robot)
    if gait.double:
        zmp, left = scheduled_zmp(gait, robot), gait.clock.single.ticks
        set_ramp(ramps[row], -gait.elapsed, zmp, (px, py), swing_foot(gait), before)
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
def copy_plan(copy: Record, plan: Record) -> None:
    """Copy a plan."""
    copy.gait, copy.landing, copy.following = plan.gait, plan.landing, plan.following
    copy.moving, copy.ramp_count, copy.step_count = plan.moving, plan.ramp_count, plan.step_count
    for k in range(plan.ramp_count):
        copy.ramps[k] = plan.ramps[k]
    for k in range(plan.step_count):
        copy.steps[k] = plan.steps[k]


@compiled
def reference_of(plan: Record) -> Record:
    """Return the ramps of a plan from now on, see `RAMP` (n,)."""
    reference: Record = plan.ramps[: plan.ramp_count]
    return reference


@compiled
def set_ramp(
    ramp: Record, ticks: int, start: Point, end: Point, unloading: Foothold, loading: Foothold
) -> None:
    """Set a ramp of the ZMP from `start` to `end` [m]."""
    ramp.ticks = ticks
    ramp.ax, ramp.ay = start
    ramp.bx, ramp.by = end
    put(ramp.unloading, unloading)
    put(ramp.loading, loading)


@compiled
def is_single(ramp: Record) -> bool:
    """Whether a ramp is a single support."""
    left: bool = ramp.unloading.left == ramp.loading.left
    return left
