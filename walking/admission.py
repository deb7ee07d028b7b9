"""Admission: transition from the last plan to the wanted one, as far as the ZMP allows.

Bisection between the last plan, which stays feasible, and the wanted one; landing, later strides
and timing change together (Lee & Kim, J. Electr. Eng. Technol. 9(1), 2014). After a disturbance the
last plan may be infeasible, too; then the generator approximates the wanted one.

A walk that ends takes the shortest footstep after which the next one can close the stance: any
other compromise takes the body farther and costs more footsteps.

A plan that is tried is a copy: the plan in force changes only when one is taken.
"""

from compilation import compiled
from walking.foothold import Foothold, foothold, put, towards
from walking.footsteps import landing_of, towards_strides
from walking.gait import aimed, plan_walk, retime, support_foot, update_phase
from walking.patterns import is_feasible, remains_feasible
from walking.records import BEST, LIVE, PAPER, TRIAL, Record
from walking.support import Region

BISECTIONS = 4  # at most 1/16 short of the maximum admissible change


@compiled
def remember(admission: Record, gait: Record) -> None:
    """Store the timing of the last tick before it changes."""
    admission.stepping, admission.clock = gait.stepping, gait.clock


@compiled
def skip(admission: Record, following: Record, moving: bool) -> None:
    """Take a plan that needs no admission."""
    admission.fraction, admission.known, admission.moving = 1.0, True, moving
    admission.following = following


@compiled
def admit(
    admission: Record,
    plans: Record,
    knots: Record,
    pendulum: Record,
    region: Region,
    wanted: Record,
    moving: bool,
    off_plan: bool,
    robot: Record,
) -> bool:
    """Give the plan in force the admitted timing, footholds and reference.

    Args:
        admission: admitted plan, changed.
        plans: plans, see `walking.records.LIVE` (3,); the one in force is changed.
        knots: knots of the plans (3, k), changed.
        pendulum: pendulum of the plan.
        region: admissible ZMP in this tick.
        wanted: strides of the wanted plan.
        moving: whether the walk goes on in the wanted plan.
        off_plan: whether the swing foot makes a capture step that leaves this plan.
        robot: constants.

    Returns:
        whether the ZMP plan in `BEST` belongs to the reference.
    """
    live, best = plans[LIVE], plans[BEST]
    gait = live.gait
    continues = admission.stepping and gait.stepping and gait.completed == admission.completed
    admission.completed = gait.completed
    if not continues or (gait.landed_early and not off_plan):
        admission.landing = gait.landing
    last = foothold(admission.landing)
    goal = last
    if gait.adjustable:
        goal = aimed(gait, last, landing_of(support_foot(gait), wanted), robot)
    plan_walk(live, goal, wanted, moving, robot)
    best.zmp = live.zmp
    if not (admission.known and admission.stepping and gait.stepping):
        _take(admission, goal, wanted, moving, 1.0)
        return False
    if is_feasible(plans, knots, LIVE, pendulum, region, robot):
        accepted = True
        _take(admission, goal, wanted, moving, 1.0)
    else:
        accepted = _compromise(
            admission, plans, knots, pendulum, region, last, goal, wanted, moving, robot
        )
    if robot.pattern.generator == PAPER:
        live.zmp = best.zmp
    return accepted


@compiled
def _compromise(
    admission: Record,
    plans: Record,
    knots: Record,
    pendulum: Record,
    region: Region,
    last: Foothold,
    goal: Foothold,
    wanted: Record,
    moving: bool,
    robot: Record,
) -> bool:
    """Take a feasible plan between the last one, landing at `last`, and the wanted one."""
    live = plans[LIVE]
    gait, admission.goal = live.gait, live.gait.clock
    if not moving and _end(admission, plans, knots, pendulum, region, last, goal, wanted, robot):
        return True
    gait.clock = admission.clock
    update_phase(gait, robot)
    plan_walk(live, last, admission.following, admission.moving, robot)
    if remains_feasible(live, robot):
        return _bisect(admission, plans, knots, pendulum, region, last, goal, wanted, robot)
    gait.clock = admission.goal
    update_phase(gait, robot)
    plan_walk(live, goal, wanted, moving, robot)
    _take(admission, goal, wanted, moving, 1.0)
    return False


@compiled
def _end(
    admission: Record,
    plans: Record,
    knots: Record,
    pendulum: Record,
    region: Region,
    last: Foothold,
    goal: Foothold,
    wanted: Record,
    robot: Record,
) -> bool:
    """Take a walk that ends after the next footstep, if one is feasible."""
    trial = plans[TRIAL]
    low, high = 0.0, 1.0
    for attempt in range(BISECTIONS + 1):
        fraction = 0.5 * (low + high) if attempt > 0 else 0.0
        landing = towards(last, goal, fraction)
        trial.gait = plans[LIVE].gait
        plan_walk(trial, landing, wanted, False, robot)
        if is_feasible(plans, knots, TRIAL, pendulum, region, robot):
            low = fraction
            trial.moving, trial.following = False, wanted
            put(trial.landing, landing)
            _keep_trial(plans)
        elif attempt == 0:
            return False
        else:
            high = fraction
    _take_best(admission, plans, low)
    return True


@compiled
def _bisect(
    admission: Record,
    plans: Record,
    knots: Record,
    pendulum: Record,
    region: Region,
    last: Foothold,
    goal: Foothold,
    wanted: Record,
    robot: Record,
) -> bool:
    """Take the plan with the maximum admitted fraction of the change, or keep the last plan.

    The last plan is the one in force.
    """
    trial, between, moving = plans[TRIAL], admission.between, admission.moving
    before, after = admission.clock.timing, admission.goal.timing
    low, high, admitted = 0.0, 1.0, False
    for _ in range(BISECTIONS):
        fraction = 0.5 * (low + high)
        between.double = before.double + round(fraction * (after.double - before.double))
        between.single = before.single + round(fraction * (after.single - before.single))
        change = after.swing_height - before.swing_height
        between.swing_height = before.swing_height + fraction * change
        trial.gait = plans[LIVE].gait
        retime(trial.gait, between, robot)
        landing = towards(last, goal, fraction)
        towards_strides(trial.following, admission.following, wanted, fraction)
        plan_walk(trial, landing, trial.following, moving, robot)
        if is_feasible(plans, knots, TRIAL, pendulum, region, robot):
            low, admitted = fraction, True
            trial.moving = moving
            put(trial.landing, landing)
            _keep_trial(plans)
        else:
            high = fraction
    if admitted:
        _take_best(admission, plans, low)
    else:
        _take(admission, last, admission.following, moving, 0.0)
    return admitted


@compiled
def _keep_trial(plans: Record) -> None:
    """Copy the plan that was tried to `BEST`, where its ZMP plan is."""
    trial, best = plans[TRIAL], plans[BEST]
    best.gait, best.landing, best.following = trial.gait, trial.landing, trial.following
    best.moving = trial.moving
    _copy_reference(best, trial)


@compiled
def _copy_reference(copy: Record, plan: Record) -> None:
    """Copy reference and footholds of a plan."""
    copy.ramp_count, copy.step_count = plan.ramp_count, plan.step_count
    for k in range(plan.ramp_count):
        copy.ramps[k] = plan.ramps[k]
    for k in range(plan.step_count):
        copy.steps[k] = plan.steps[k]


@compiled
def _take_best(admission: Record, plans: Record, fraction: float) -> None:
    """Put the best admitted plan in force."""
    live, best = plans[LIVE], plans[BEST]
    live.gait = best.gait
    _copy_reference(live, best)
    _take(admission, foothold(best.landing), best.following, best.moving, fraction)


@compiled
def _take(
    admission: Record, landing: Foothold, following: Record, moving: bool, fraction: float
) -> None:
    put(admission.landing, landing)
    admission.following = following
    admission.known, admission.moving, admission.fraction = True, moving, fraction
