"""Planned footholds, and the ZMP reference that they give."""

from compilation import compiled
from walking.foothold import Foothold, foothold, put
from walking.footsteps import is_parallel, landing_of
from walking.plane import Point, from_frame
from walking.records import Record


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
def chain_footholds(
    steps: Record,
    support: Foothold,
    landing: Foothold,
    following: Record,
    moving: bool,
    robot: Record,
) -> tuple[int, bool]:
    """Set the footholds of a walk, that of the swing foot first.

    Args:
        steps: footholds (n,), set.
        support: support foot.
        landing: foothold of the swing foot.
        following: strides of the footsteps after it.
        moving: whether the walk goes on; if not, it ends as soon as the stance is parallel.
        robot: constants.

    Returns:
        number of footholds, and whether the walk ends after the last.
    """
    before, last = support, landing
    number = steps.shape[0]
    for k in range(number):
        put(steps[k], last)
        if k + 1 < number and not moving and is_parallel(before, last, robot):
            return k + 1, True
        before, last = last, landing_of(last, following)
    return number, False


@compiled
def reference_ramps(
    ramps: Record,
    unloading: Foothold,
    support: Foothold,
    steps: Record,
    count: int,
    ends: bool,
    zmp: Point,
    ticks: tuple[int, int, int, int, int],
    robot: Record,
) -> int:
    """Set the ZMP reference of a walk from now on; return the number of its ramps.

    Args:
        ramps: set (n,).
        unloading: foot that swings next.
        support: support foot of this footstep.
        steps: planned footholds.
        count: number of these.
        ends: whether the walk ends with equal loads after the last foothold.
        zmp: present ZMP, in double support [m].
        ticks: remaining ticks of the present double support, zero in single support; of the
            single support after it; ticks of later double and single supports; of the last
            double support.
        robot: constants.
    """
    shift, carry, double, single, stop = ticks
    px, py = zmp_under(support, robot)
    row = 0
    if shift > 0:
        set_ramp(ramps[row], shift, zmp, (px, py), unloading, support)
        row += 1
    set_ramp(ramps[row], carry, (px, py), (px, py), support, support)
    row += 1
    before = support
    for k in range(count):
        step = foothold(steps[k])
        x, y = zmp_under(step, robot)
        if ends and k == count - 1:
            bx, by = zmp_under(before, robot)
            set_ramp(ramps[row], stop, (px, py), (0.5 * (bx + x), 0.5 * (by + y)), before, step)
            row += 1
        else:
            set_ramp(ramps[row], double, (px, py), (x, y), before, step)
            set_ramp(ramps[row + 1], single, (x, y), (x, y), step, step)
            row += 2
        before, px, py = step, x, y
    return row


@compiled
def reference_of(plan: Record) -> Record:
    """Return the ramps of a plan from now on, see `walking.records.RAMP` (n,)."""
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
