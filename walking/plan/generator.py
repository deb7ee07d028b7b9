"""Pattern generators: motion of the pendulum along a piecewise-linear ZMP reference.

Both receive the reference in every control tick, so footholds may change at any time. "preview"
tracks the DCM of any reference, its infinite-horizon preview sum, see `dcm_reference`. "mwpg"
admits only references that its ZMP can follow inside the sole, see `walking.plan.admission` and
`walking.plan.mwpg`.
"""

from compilation import compiled
from walking.data import Data, Gait
from walking.model import Model
from walking.plan.admission import admit_modified
from walking.plan.departure import advance_modified
from walking.plan.footsteps import Foothold, foothold, landing_of
from walking.plan.gait import is_adjustable, is_double, support_foot
from walking.plan.mwpg import reachable_dcm
from walking.plan.pendulum import dcm_reference, plan_pendulum, track_reference
from walking.plan.reference import plan_walk, reference_of
from walking.plan.steering import moves
from walking.plan.support import Region
from walking.plane import Point


@compiled
def keeps_plan(gait: Gait, robot: Model) -> bool:
    """Whether the plan goes on unchanged when a capture step leaves it."""
    return robot.modifiable and not gait.shortened


@compiled
def admit(walk: Data, region: Region, robot: Model) -> Foothold:
    """Put the plan of the wanted strides in force, as far as the generator can follow it.

    Args:
        walk: state, its plan and admission are changed.
        region: admissible ZMP in this tick.
        robot: constants.

    Returns:
        landing of the plan.
    """
    plan, steering, gait = walk.plan, walk.steering, walk.plan.gait
    if keeps_plan(gait, robot):
        admit_modified(walk, region, robot)
    else:
        walk.admission.fraction = 1.0
        landing = foothold(gait.landing)
        if is_adjustable(gait, robot):
            landing = landing_of(support_foot(gait), steering.wanted)
        plan_walk(plan, landing, steering.wanted, moves(steering), robot)
    return foothold(plan.steps[0])


@compiled
def advance_pendulum(walk: Data, region: Region, robot: Model) -> None:
    """Advance the pendulum by a tick; its ZMP stays in the region.

    Args:
        walk: state, its pendulums are changed.
        region: admissible ZMP.
        robot: constants.
    """
    if keeps_plan(walk.plan.gait, robot):
        advance_modified(walk, region, robot)
    else:
        gain = robot.pattern.dcm_gain
        track_reference(walk.pendulum, robot, gain, reference_of(walk.plan), region)


@compiled
def planned_dcm(walk: Data, robot: Model) -> Point:
    """Return the reference of the DCM for balance feedback [m]."""
    if keeps_plan(walk.plan.gait, robot):
        return reachable_dcm(walk.functions, plan_pendulum(walk), robot)
    return dcm_reference(reference_of(walk.plan), robot)


@compiled
def planned_zmp(walk: Data, robot: Model) -> Point:
    """Return the ZMP of the plan on the support foot [m]."""
    gait, ramp = walk.plan.gait, walk.plan.ramps[0]
    if keeps_plan(gait, robot) and not is_double(gait):
        pendulum = plan_pendulum(walk)
        return pendulum.zmp_x, pendulum.zmp_y
    return ramp.bx, ramp.by
