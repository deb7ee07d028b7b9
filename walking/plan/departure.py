"""Capture steps of the modifiable pattern: the body departs from the plan and returns to it.

The ZMP functions cannot plan for footholds that a push dictates. During a capture step the plan
continues as the reference of the DCM error, and the pendulum of the body tracks the DCM that leads
to the actual landing. At touchdown the two become one.
"""

from compilation import compiled
from walking.data import Data
from walking.model import Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import equal, foothold
from walking.plan.gait import is_double, phase_of
from walking.plan.mwpg import advance_functions, reset_target
from walking.plan.pendulum import dcm_of, plan_pendulum, ramp_weights, track_dcm
from walking.plan.reference import reference_of
from walking.plan.support import Region


@compiled
def advance_modified(walk: Data, region: Region, robot: Model) -> None:
    """Advance the pendulums of plan and body by one tick.

    Args:
        walk: state, its pendulums are changed.
        region: admissible ZMP.
        robot: constants.
    """
    body, plan, gait = walk.pendulum, walk.plan, walk.plan.gait
    landing, planned = foothold(gait.landing), foothold(plan.steps[0])
    phase = phase_of(gait)
    if not (phase.double or walk.off_plan or equal(landing, planned)):
        walk.planned, walk.off_plan = body, True
    pendulum = plan_pendulum(walk)
    x, y = dcm_of(pendulum, robot)
    advance_functions(walk.functions, pendulum, reference_of(plan), region, robot)
    if walk.off_plan:
        # Shift of the DCM by a ramp of the ZMP from the fixed support foot to the new landing.
        wh = robot.omega * CONTROL_PERIOD
        growth, _, last = ramp_weights(wh, gait.clock.timing.double)
        weight = (1.0 + last) / growth / ramp_weights(wh, phase.ticks_left)[0]
        x += weight * (landing.x - planned.x)
        y += weight * (landing.y - planned.y)
        zmp = (pendulum.zmp_x, pendulum.zmp_y)
        track_dcm(body, robot, robot.pattern.dcm_gain, (x, y), zmp, region)


@compiled
def end_capture(walk: Data) -> None:
    """At touchdown, restart the plan from the pendulum of the body."""
    if walk.off_plan and is_double(walk.plan.gait):
        return_to_plan(walk)


@compiled
def return_to_plan(walk: Data) -> None:
    """Restart the plan from the pendulum of the body."""
    walk.off_plan = False
    reset_target(walk.functions)
