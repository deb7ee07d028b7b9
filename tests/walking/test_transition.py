"""A change that the ZMP cannot follow is made in part, and nothing else is touched."""

import numpy as np
import pytest

from walking.footsteps import FootstepPlanner
from walking.gait import Gait
from walking.parameters import WalkingParameters
from walking.pattern import PendulumState
from walking.state import Footstep
from walking.stride import Strides, Timing
from walking.support import support_region
from walking.transition import BISECTIONS, Transition

PARAMETERS = WalkingParameters()
TIME = PARAMETERS.gait.footstep_time
STANCE = 2.0 * PARAMETERS.gait.half_stance
SLOW, FAST = (
    Strides(right=(v * TIME, -STANCE, 0.0), left=(v * TIME, STANCE, 0.0)) for v in (0.1, 0.3)
)


class UpTo:
    """Admits landings no further ahead than `reach`."""

    selective = True

    def __init__(self, gait):
        self.gait, self.reach, self.asked = gait, np.inf, []

    def admits(self, state, ramps, region):
        self.asked.append(ramps)
        return self.gait.landing.x <= self.reach


@pytest.fixture
def setting(robot):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    h = PARAMETERS.gait.half_stance
    stance = (Footstep(True, 0.0, h, 0.0), Footstep(False, 0.0, -h, 0.0))
    gait = Gait(PARAMETERS, planner, stance)
    gait.start(0)
    generator = UpTo(gait)
    region = support_region(robot.sole, *stance, 0.005)
    return gait, generator, Transition(gait, generator), region


def tick(setting, wish, *, forced=False, timing=None):
    gait, _, transition, region = setting
    transition.remember()
    if timing is not None:
        gait.retime(timing)
    gait.aim(gait.nominal(wish))
    ramps = gait.plan(gait.landing, wish, moving=True)
    state = PendulumState(0.0, 0.0)
    return transition.admit(state, ramps, region, wish, moving=True, forced=forced)


def test_an_admitted_change_is_made_at_once(setting):
    tick(setting, SLOW)
    tick(setting, FAST)
    gait, _, transition, _ = setting
    assert transition.share == 1.0
    assert gait.landing.x == pytest.approx(0.3 * TIME)


def test_the_largest_admitted_share_is_found(setting):
    gait, generator, transition, _ = setting
    tick(setting, SLOW)
    slow = gait.landing.x
    fast = 3.0 * slow
    generator.reach = slow + 0.6 * (fast - slow)
    ramps = tick(setting, FAST)
    assert 0.6 - 0.5**BISECTIONS <= transition.share <= 0.6
    assert gait.landing.x == pytest.approx(slow + transition.share * (fast - slow))
    assert any(ramps is one for one in generator.asked)
    assert transition.strides.right[0] == pytest.approx(gait.landing.x)


def test_if_nothing_is_admitted_the_old_plan_goes_on(setting):
    gait, generator, transition, _ = setting
    tick(setting, SLOW)
    before, clock = tick(setting, SLOW), gait.clock()
    generator.reach = -1.0
    after = tick(setting, FAST, timing=Timing(20, 80, 0.03))
    assert transition.share == 0.0
    assert after == before
    assert gait.clock() == clock


def test_times_change_by_the_same_share(setting):
    gait, generator, transition, _ = setting
    tick(setting, SLOW)
    generator.reach = 0.5 * (gait.landing.x + 3.0 * gait.landing.x) + 1e-9
    usual = gait.timing
    tick(setting, FAST, timing=Timing(14, 74, 0.025))
    assert transition.share == 0.5
    assert gait.timing.single == round(0.5 * (usual.single + 74))


def test_a_forced_landing_is_never_turned_down_but_the_rest_is(setting):
    gait, generator, transition, _ = setting
    tick(setting, SLOW)
    slow, timing = transition.strides, gait.timing
    generator.reach = -1.0
    tick(setting, FAST, forced=True, timing=Timing(20, 80, 0.03))
    assert gait.landing.x == pytest.approx(0.3 * TIME)
    assert transition.strides == slow
    assert gait.timing == timing
