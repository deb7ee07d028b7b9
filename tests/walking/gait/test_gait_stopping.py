"""From full speed to standing: at most two footsteps begin after the command."""

import pytest

from walking.body.sole import Sole
from walking.command import VelocityCommand
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.steering import Steering
from walking.footsteps.stride import STILL
from walking.gait.gait import Gait
from walking.parameters import WalkingParameters

PARAMETERS = WalkingParameters()
LIMITS = PARAMETERS.limits
SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
PLANNER = FootstepPlanner(PARAMETERS.gait, LIMITS, SOLE)
FASTEST = [
    (LIMITS.vx, 0.0, 0.0),
    (-LIMITS.vx_backward, 0.0, 0.0),
    (0.0, LIMITS.vy, 0.0),
    (0.0, 0.0, -LIMITS.wz),
    (0.4, -0.1, 0.8),
]


def walk(velocity, stop_at, *, selective):
    """Footsteps completed by the command to stop and by the time of standing."""
    h = PARAMETERS.gait.half_stance
    gait = Gait(
        PARAMETERS, PLANNER, (Foothold(True, 0.0, h, 0.0), Foothold(False, 0.0, -h, 0.0)), SOLE
    )
    steering = Steering(PLANNER, LIMITS, selective=selective)
    gait.start(0)
    at_stop = 0
    for tick in range(stop_at + 400):
        command = VelocityCommand(*velocity) if tick < stop_at else VelocityCommand()
        if tick == stop_at:
            at_stop = gait.completed
        steering.follow(command, settled=True, balanced=True, speed_ratio=1.0)
        gait.retime(steering.next_timing(gait.timing, stepping=gait.stepping))
        wish = steering.strides(STILL)
        if gait.adjustable:
            gait.aim(gait.nominal(wish))
        gait.plan(gait.landing, wish, moving=steering.moving)
        gait.advance(moving=steering.moving)
        if tick >= stop_at and not gait.stepping:
            break
    assert not gait.stepping
    assert PLANNER.parallel(*gait.footholds)
    return at_stop, gait.completed


@pytest.mark.parametrize("selective", [False, True])
@pytest.mark.parametrize("velocity", FASTEST)
def test_two_footsteps_stop_the_fastest_walk_from_any_phase(velocity, selective):
    for stop_at in range(400, 540, 17):
        before, after = walk(velocity, stop_at, selective=selective)
        # The footstep under way when the command comes is finished first.
        assert after - before <= 3, (stop_at, before, after)
