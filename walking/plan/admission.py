"""Admission: transition from the last plan to the wanted one, as far as the ZMP allows.

Bisection between the last plan, which stays feasible, and the wanted one; landing, later strides
and timing change together (Lee & Kim, J. Electr. Eng. Technol. 9(1), 2014). After a disturbance the
last plan may be infeasible, too; then the ZMP functions approximate the wanted one.

A walk that ends takes the shortest footstep after which the next one can close the stance: any
other compromise takes the body farther and costs more footsteps.

A plan that is tried is a copy: the plan in force changes only when one is taken.
"""

from compilation import compiled
from walking.data import Data, Plan
from walking.model import Model
from walking.plan.footsteps import foothold, landing_of, towards, towards_strides
from walking.plan.gait import aimed, is_adjustable, retime, support_foot
from walking.plan.mwpg import admits_target, reaches_target
from walking.plan.pendulum import plan_pendulum
from walking.plan.reference import copy_plan, plan_walk, reference_of
from walking.plan.steering import moves
from walking.plan.support import Region

BISECTIONS = 4  # at most 1/16 short of the maximum admissible change


@compiled
def remember(walk: Data) -> None:
    """Store the timing of the last tick before it changes."""
    admission, gait = walk.admission, walk.plan.gait
    admission.stepping, admission.clock = gait.stepping, gait.clock


@compiled
def admit_modified(walk: Data, region: Region, robot: Model) -> None:
    """Put the plan of the wanted strides in force, as far as it is feasible.

    Args:
        walk: state, its plan and admission are changed.
        region: admissible ZMP in this tick.
        robot: constants.
    """
    admission, live, wanted = walk.admission, walk.plan, walk.admission.wanted
    gait = live.gait
    continues = admission.stepping and gait.stepping and gait.completed == admission.completed
    admission.completed = gait.completed
    # A capture step leaves the plan.
    if not continues or (gait.landed_early and not walk.off_plan):
        live.landing = gait.landing
    last = foothold(live.landing)
    goal = last
    if is_adjustable(gait, robot):
        goal = aimed(gait, last, landing_of(support_foot(gait), walk.steering.wanted), robot)
    wanted.gait = gait
    plan_walk(wanted, goal, walk.steering.wanted, moves(walk.steering), robot)
    admission.functions = walk.functions
    if not (admission.stepping and gait.stepping):
        _take(walk, wanted, 1.0)
        return
    if _is_feasible(walk, wanted, region, robot):
        _take(walk, wanted, 1.0)
    else:
        _compromise(walk, region, robot)
    walk.functions = admission.functions


@compiled
def _is_feasible(walk: Data, plan: Plan, region: Region, robot: Model) -> bool:
    """Whether the ZMP can follow a plan inside the sole; then set the tried functions."""
    functions, pendulum = walk.admission.functions, plan_pendulum(walk)
    return admits_target(functions, pendulum, reference_of(plan), region, robot)


@compiled
def _compromise(walk: Data, region: Region, robot: Model) -> None:
    """Take a feasible plan between the last one and the wanted one."""
    live, wanted = walk.plan, walk.admission.wanted
    if not wanted.moving and _end(walk, region, robot):
        return
    live.gait.clock = walk.admission.clock
    plan_walk(live, foothold(live.landing), live.following, live.moving, robot)
    if reaches_target(walk.functions):
        _bisect(walk, region, robot)
    else:
        _take(walk, wanted, 1.0)


@compiled
def _end(walk: Data, region: Region, robot: Model) -> bool:
    """Take a walk that ends after the next footstep, if one is feasible."""
    wanted, trial, best = walk.admission.wanted, walk.admission.trial, walk.admission.best
    last, goal, low, high = foothold(walk.plan.landing), foothold(wanted.landing), 0.0, 1.0
    for attempt in range(BISECTIONS + 1):
        fraction = 0.5 * (low + high) if attempt > 0 else 0.0
        trial.gait = wanted.gait
        plan_walk(trial, towards(last, goal, fraction), wanted.following, False, robot)
        if _is_feasible(walk, trial, region, robot):
            low = fraction
            copy_plan(best, trial)
        elif attempt == 0:
            return False
        else:
            high = fraction
    _take(walk, best, low)
    return True


@compiled
def _bisect(walk: Data, region: Region, robot: Model) -> None:
    """Take the plan with the maximum admitted fraction of the change, or keep the last plan."""
    live, wanted, trial = walk.plan, walk.admission.wanted, walk.admission.trial
    best = walk.admission.best
    before, after = live.gait.clock.timing, wanted.gait.clock.timing
    last, goal, between = foothold(live.landing), foothold(wanted.landing), walk.admission.between
    low, high, admitted = 0.0, 1.0, False
    for _ in range(BISECTIONS):
        fraction = 0.5 * (low + high)
        between.double = before.double + round(fraction * (after.double - before.double))
        between.single = before.single + round(fraction * (after.single - before.single))
        change = after.swing_height - before.swing_height
        between.swing_height = before.swing_height + fraction * change
        trial.gait = live.gait
        retime(trial.gait, between, robot)
        towards_strides(trial.following, live.following, wanted.following, fraction)
        landing = towards(last, goal, fraction)
        plan_walk(trial, landing, trial.following, live.moving, robot)
        if _is_feasible(walk, trial, region, robot):
            low, admitted = fraction, True
            copy_plan(best, trial)
        else:
            high = fraction
    if admitted:
        _take(walk, best, low)
    else:
        walk.admission.fraction = 0.0


@compiled
def _take(walk: Data, plan: Plan, fraction: float) -> None:
    """Put a plan in force that makes a fraction of the wanted change [1]."""
    copy_plan(walk.plan, plan)
    walk.admission.fraction = fraction
