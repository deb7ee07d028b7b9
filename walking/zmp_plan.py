"""Robust pattern: a planned ZMP inside the soles at all times, between ticks, too.

The planned ZMP is linear between knots at absolute times. Every knot of a single support is in the
sole, every knot of a double support in a parallelogram between the soles, the last one on the next
support sole; a segment within a convex set stays in it, so nothing is sampled. Along such a ZMP the
pendulum is exact and its present DCM is a weighted sum of the knots,

    ξ(0) = Σ_j w_j p_j + D ξ_ref,

with ξ_ref the DCM of the rest of the reference, which comes to rest on its last foothold. A plan
that satisfies this equation and the bounds of all knots can be walked to its end: it is feasible
again in the next tick, and is kept if a new one is infeasible. The plan nearest to the reference is

    minimize Σ |u_j - û_j|²  subject to  Σ w_j (centre_j + M_j u_j) = DCM,  u_j in its box,

solved in `walking.zmp_solver`. Knots in the same parallelogram are a cell, see `CELL`.
"""

from compilation import compiled
from compilation.record import record_type
from walking.footsteps import FOOTHOLD, equal
from walking.parameters import CONTROL_PERIOD
from walking.pendulum import ramp_weights, slide_tick, track_reference
from walking.records import Record
from walking.reference import BEST, LIVE
from walking.support import Region
from walking.zmp_program import Sole, lay_out
from walking.zmp_solver import solve

SUPPORT = record_type(end=int, unloading=FOOTHOLD, loading=FOOTHOLD)
"""Support phase of a plan: its end in ticks from the begin of the plan, and its feet."""

COMPARED = 5
"""Supports of a plan that are compared with a later reference."""

ZMP_PLAN = record_type(
    exists=bool,
    age=int,
    dual_x=float,
    dual_y=float,
    count=int,
    next=int,
    supports=(SUPPORT, COMPARED),
    phases=int,
)
"""Plan of the ZMP, see `walking.zmp_plan`: whether there is one, its age in ticks, λ of the program
[1/m], number of knots and index of the next one, first support phases and their number."""

CHECKED = 2  # supports of a reference that must be those of a plan that is kept


@compiled
def admits_knots(
    plans: Record, knots: Record, pendulum: Record, ramps: Record, margin: float, robot: Record
) -> bool:
    """Plan the ZMP nearest to a reference; return whether it is feasible.

    Args:
        plans: plans (4,); the ZMP plan of `BEST` is set if feasible. The dual of that in force is
            the initial guess.
        knots: knots of the plans (4, k); those of `BEST` are set if feasible.
        pendulum: present pendulum.
        ramps: reference.
        margin: margin of the knots in the soles [m].
        robot: constants.
    """
    live, trial = plans[LIVE].zmp, plans[BEST].zmp
    support = robot.support
    sole = Sole(support.centre, support.half_length - margin, support.half_width - margin)
    program = lay_out(ramps, pendulum, sole, robot, robot.pattern.zmp_rate * CONTROL_PERIOD)
    guess = (0.0, 0.0)
    if live.exists:
        growth, _, _ = ramp_weights(robot.omega * CONTROL_PERIOD, live.age)
        guess = (live.dual_x / growth, live.dual_y / growth)
    feasible, dual, _ = solve(program.cells, program.weights, program.dcm, guess, program.knots)
    if not feasible:
        return False
    trial.exists, trial.age, trial.next = True, 0, 0
    trial.dual_x, trial.dual_y = dual
    trial.count = program.knots.shape[0]
    for k in range(trial.count):
        knots[BEST, k] = program.knots[k]
    trial.phases, end = min(COMPARED, len(ramps)), 0
    for k in range(trial.phases):
        end += ramps[k].ticks
        phase = trial.supports[k]
        phase.end, phase.unloading, phase.loading = end, ramps[k].unloading, ramps[k].loading
    return True


@compiled
def remains_feasible(live: Record, ramps: Record) -> bool:
    """Whether the plan in force stays feasible under a reference, by its next supports."""
    if not live.exists or live.next == live.count:
        return False
    end = live.age
    for k in range(min(CHECKED, len(ramps))):
        end += ramps[k].ticks
        planned = False
        for number in range(live.phases):
            phase = live.supports[number]
            planned = planned or (
                phase.end == end
                and equal(phase.unloading, ramps[k].unloading)
                and equal(phase.loading, ramps[k].loading)
            )
        if not planned:
            return False
    return True


@compiled
def advance_knots(
    plans: Record,
    knots: Record,
    accepted: bool,
    pendulum: Record,
    ramps: Record,
    region: Region,
    robot: Record,
) -> None:
    """Advance the pendulum by a tick along the plan; without a plan, track the DCM.

    Args:
        plans: plans (4,); the ZMP plan in force is replaced.
        knots: knots of the plans (4, k).
        accepted: whether the ZMP plan of `BEST` is that of this tick.
        pendulum: changed.
        ramps: reference.
        region: admissible ZMP.
        robot: constants.
    """
    live, pattern = plans[LIVE].zmp, robot.pattern
    new = accepted or admits_knots(plans, knots, pendulum, ramps, pattern.plan_margin, robot)
    if not new and not remains_feasible(live, ramps):
        new = admits_knots(plans, knots, pendulum, ramps, pattern.sole_margin, robot)
        live.exists, live.age = False, 0
    if new:
        plans[LIVE].zmp = plans[BEST].zmp
        for k in range(live.count):
            knots[LIVE, k] = knots[BEST, k]
    if not live.exists:
        track_reference(pendulum, robot, pattern.dcm_gain, ramps, region)
        return
    _follow(live, knots[LIVE], pendulum, robot)
    live.age += 1


@compiled
def _follow(live: Record, knots: Record, pendulum: Record, robot: Record) -> None:
    """Advance the pendulum by a tick along the knots; beyond the last the ZMP stays."""
    x, y = pendulum.zmp_x, pendulum.zmp_y
    px, py = x, y
    if live.next < live.count:
        knot = knots[live.next]
        if knot.ticks == 1.0:
            px, py = knot.x, knot.y
            live.next += 1
        else:
            px, py = x + (knot.x - x) / knot.ticks, y + (knot.y - y) / knot.ticks
            knot.ticks -= 1.0
    pendulum.x, pendulum.vx = slide_tick(robot, pendulum.x, pendulum.vx, x, px)
    pendulum.y, pendulum.vy = slide_tick(robot, pendulum.y, pendulum.vy, y, py)
    pendulum.zmp_x, pendulum.zmp_y = px, py
