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
from walking.plan.reference import plan_walk, reference_of
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
        live.steps[0] = gait.landing
    last = foothold(live.steps[0])
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
    plan_walk(live, foothold(live.steps[0]), live.following, live.moving, robot)
    if reaches_target(walk.functions):
        _bisect(walk, region, robot)
    else:
        _take(walk, wanted, 1.0)


@compiled
def _end(walk: Data, region: Region, robot: Model) -> bool:
    """Take a walk that ends after the next footstep, if one is feasible."""
    trial, low, high = walk.admission.trial, 0.0, 1.0
    _plan_end(walk, 0.0, robot)
    if not _is_feasible(walk, trial, region, robot):
        return False
    for _ in range(BISECTIONS):
        fraction = 0.5 * (low + high)
        _plan_end(walk, fraction, robot)
        if _is_feasible(walk, trial, region, robot):
            low = fraction
        else:
            high = fraction
    _plan_end(walk, low, robot)
    _take(walk, trial, low)
    return True


@compiled
def _plan_end(walk: Data, fraction: float, robot: Model) -> None:
    """Try a walk that ends, with a landing between the last and the wanted one."""
    wanted, trial = walk.admission.wanted, walk.admission.trial
    last, goal = foothold(walk.plan.steps[0]), foothold(wanted.steps[0])
    trial.gait = wanted.gait
    plan_walk(trial, towards(last, goal, fraction), wanted.following, False, robot)


@compiled
def _bisect(walk: Data, region: Region, robot: Model) -> None:
    """Take the plan with the maximum admitted fraction of the change, or keep the last plan."""
    trial, low, high = walk.admission.trial, 0.0, 1.0
    for _ in range(BISECTIONS):
        fraction = 0.5 * (low + high)
        _plan_between(walk, fraction, robot)
        if _is_feasible(walk, trial, region, robot):
            low = fraction
        else:
            high = fraction
    walk.admission.fraction = low
    if low > 0.0:
        _plan_between(walk, low, robot)
        _take(walk, trial, low)


@compiled
def _plan_between(walk: Data, fraction: float, robot: Model) -> None:
    """Try a plan that makes a fraction of the wanted change [1]."""
    last, wanted, trial = walk.plan, walk.admission.wanted, walk.admission.trial
    before, after, between = (
        last.gait.clock.timing,
        wanted.gait.clock.timing,
        walk.admission.between,
    )
    between.double = before.double + round(fraction * (after.double - before.double))
    between.single = before.single + round(fraction * (after.single - before.single))
    change = after.swing_height - before.swing_height
    between.swing_height = before.swing_height + fraction * change
    trial.gait = last.gait
    retime(trial.gait, between, robot)
    towards_strides(trial.following, last.following, wanted.following, fraction)
    landing = towards(foothold(last.steps[0]), foothold(wanted.steps[0]), fraction)
    plan_walk(trial, landing, trial.following, last.moving, robot)


@compiled
def _take(walk: Data, plan: Plan, fraction: float) -> None:
    """Put a plan in force that makes a fraction of the wanted change [1]."""
    walk.plan = plan
    walk.admission.fraction = fraction
