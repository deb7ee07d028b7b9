"""Pattern generators: motion of the pendulum along a piecewise-linear ZMP reference.

Both receive the reference in every control tick, so footholds may change at any time. "preview"
tracks the DCM of any reference, its infinite-horizon preview sum, see
`walking.pendulum.dcm_reference`. "mwpg" admits only references that its ZMP can follow inside the
sole, see `walking.admission` and `walking.mwpg`. No other module depends on the choice.
"""

from compilation import compiled
from walking.admission import admit_modified
from walking.footsteps import Foothold, foothold, landing_of
from walking.gait import support_foot
from walking.mwpg import is_selected, reachable_dcm
from walking.pendulum import dcm_reference, plan_pendulum, track_reference
from walking.plan_departure import advance_modified
from walking.plane import Point
from walking.records import Record
from walking.reference import LIVE, plan_walk, reference_of
from walking.steering import moves
from walking.support import Region


@compiled
def keeps_plan(gait: Record, robot: Record) -> bool:
    """Whether the plan goes on unchanged when a capture step leaves it."""
    keeps: bool = is_selected(robot) and not gait.shortened
    return keeps


@compiled
def admit(walk: Record, plans: Record, region: Region, robot: Record) -> Foothold:
    """Put the plan of the wanted strides in force, as far as the generator can follow it.

    Args:
        walk: state, its admission is changed.
        plans: plans (4,), see `LIVE`; changed.
        region: admissible ZMP in this tick.
        robot: constants.

    Returns:
        landing of the plan.
    """
    live, steering = plans[LIVE], walk.steering
    gait = live.gait
    if keeps_plan(gait, robot):
        admit_modified(walk, plans, region, robot)
    else:
        walk.admission.fraction = 1.0
        landing = foothold(gait.landing)
        if gait.adjustable:
            landing = landing_of(support_foot(gait), steering.wanted)
        plan_walk(live, landing, steering.wanted, moves(steering), robot)
    return foothold(live.landing)


@compiled
def advance(walk: Record, plan: Record, region: Region, robot: Record) -> None:
    """Advance the pendulum by a tick; its ZMP stays in the region.

    Args:
        walk: state, its pendulums are changed.
        plan: plan in force.
        region: admissible ZMP.
        robot: constants.
    """
    if keeps_plan(plan.gait, robot):
        advance_modified(walk, plan, region, robot)
    else:
        gain = robot.pattern.dcm_gain
        track_reference(walk.pendulum, robot, gain, reference_of(plan), region)


@compiled
def planned_dcm(walk: Record, plan: Record, robot: Record) -> Point:
    """Return the reference of the DCM for balance feedback [m]."""
    if keeps_plan(plan.gait, robot):
        return reachable_dcm(walk.functions, plan_pendulum(walk), robot)
    return dcm_reference(reference_of(plan), robot)
