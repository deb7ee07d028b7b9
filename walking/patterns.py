"""Pattern generators: motion of the pendulum along a piecewise-linear ZMP reference.

All receive the reference in every control tick, so footholds may change at any time. "dcm" and
"preview" track any reference, with delay if necessary. "paper" and "robust" reject infeasible
references: they admit only those that keep the ZMP inside the soles, and plan the ZMP, see
`walking.paper_pattern` and `walking.zmp_plan`.
"""

from compilation import compiled
from walking.arrays import Point
from walking.paper_pattern import (
    admits_target,
    advance_functions,
    forget_target,
    reachable_dcm,
)
from walking.pendulum import dcm_of, dcm_reference, track_reference
from walking.preview import advance_preview
from walking.records import DCM, PAPER, PREVIEW, ROBUST, Record
from walking.support import Region
from walking.zmp_plan import admits_knots, advance_knots
from walking.zmp_plan import remains_feasible as knots_remain_feasible


@compiled
def rejects_infeasible(parameters: Record) -> bool:
    """Whether the generator rejects some references."""
    selective: bool = parameters.pattern.generator >= PAPER
    return selective


@compiled
def is_feasible(
    trial: Record,
    live: Record,
    knots: Record,
    pendulum: Record,
    ramps: Record,
    count: int,
    region: Region,
    robot: Record,
    parameters: Record,
) -> bool:
    """Whether the pendulum can follow a reference with the ZMP inside the soles.

    Args:
        trial: ZMP plan of the reference, set if feasible.
        live: ZMP plan in force.
        knots: knots of `trial`.
        pendulum: present pendulum.
        ramps: reference from now on.
        count: number of its ramps.
        region: admissible ZMP in this tick.
        robot: constants.
        parameters: of the walk.
    """
    pattern = parameters.pattern
    if pattern.generator == ROBUST:
        margin, rate = pattern.plan_margin, pattern.zmp_rate
        return admits_knots(trial, live, knots, pendulum, ramps, count, robot, margin, rate)
    if pattern.generator == PAPER:
        return admits_target(trial, pendulum, ramps, count, region, robot)
    return True


@compiled
def remains_feasible(live: Record, ramps: Record, count: int, parameters: Record) -> bool:
    """Whether the present plan stays feasible under a reference."""
    if parameters.pattern.generator == ROBUST:
        return knots_remain_feasible(live, ramps, count)
    if parameters.pattern.generator == PAPER:
        reached: bool = live.missed_x == 0.0 and live.missed_y == 0.0
        return reached
    return True


@compiled
def reset_plan(live: Record) -> None:
    """Drop the present ZMP plan after a jump of the pendulum."""
    live.exists, live.age = False, 0
    forget_target(live)


@compiled
def advance_pattern(
    live: Record,
    knots: Record,
    trial: Record,
    tried: Record,
    accepted: bool,
    pendulum: Record,
    ramps: Record,
    count: int,
    region: Region,
    robot: Record,
    parameters: Record,
    sums: Record,
) -> None:
    """Advance the pendulum by a tick; its ZMP stays in the region.

    Args:
        live: ZMP plan in force, changed.
        knots: its knots.
        trial: ZMP plan admitted in this tick, if `accepted`.
        tried: its knots.
        accepted: whether the reference was admitted.
        pendulum: changed.
        ramps: reference from now on.
        count: number of its ramps.
        region: admissible ZMP.
        robot: constants.
        parameters: of the walk.
        sums: sums of the gains of preview control.
    """
    generator = parameters.pattern.generator
    if generator == ROBUST:
        advance_knots(
            live, knots, trial, tried, accepted, pendulum, ramps, count, region, robot, parameters
        )
    elif generator == PAPER:
        advance_functions(live, pendulum, ramps, count, region, robot, parameters)
    elif generator == PREVIEW:
        advance_preview(pendulum, ramps, count, region, robot, sums)
    else:
        gain = parameters.pattern.dcm_gain
        track_reference(pendulum, robot, gain, ramps, count, region)


@compiled
def planned_dcm(
    live: Record, pendulum: Record, ramps: Record, count: int, robot: Record, parameters: Record
) -> Point:
    """Return the reference of the DCM for balance feedback [m].

    With a weight on the ZMP rate, preview control deviates from the DCM of the footholds.
    """
    generator = parameters.pattern.generator
    if generator == PAPER:
        return reachable_dcm(live, pendulum, robot)
    if generator == DCM or (generator == ROBUST and not live.exists):
        return dcm_reference(ramps, count, robot)
    return dcm_of(pendulum, robot)
