"""Transition to a plan that the generator admits in part only."""

import numpy as np
import pytest

from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import Strides, Timing
from walking.gait.gait import Gait
from walking.gait.transition import BISECTIONS, Transition
from walking.parameters import WalkingParameters
from walking.pattern.pendulum import PendulumState
from walking.pattern.support import support_region

PARAMETERS = WalkingParameters()
TIME = PARAMETERS.gait.footstep_time
STANCE = 2.0 * PARAMETERS.gait.half_stance
SLOW, FAST = (
    Strides(right=(v * TIME, -STANCE, 0.0), left=(v * TIME, STANCE, 0.0)) for v in (0.1, 0.3)
)


STILL = Strides(right=(0.0, -STANCE, 0.0), left=(0.0, STANCE, 0.0))


class UpTo:
    """Admits landings no further ahead than `reach`."""

    selective = True

    def __init__(self, gait):
        self.gait, self.reach, self.arguments, self.lost = gait, np.inf, [], False

    def admits(self, state, ramps, region):
        self.arguments.append(ramps)
        return self.landing(ramps) <= self.reach

    def holds(self, ramps):
        return not self.lost

    @staticmethod
    def landing(ramps):
        return next(r for r in ramps if not r.feet[1].left).feet[1].x


@pytest.fixture
def setting(robot):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    h = PARAMETERS.gait.half_stance
    stance = (Foothold(True, 0.0, h, 0.0), Foothold(False, 0.0, -h, 0.0))
    gait = Gait(PARAMETERS, planner, stance, robot.sole)
    gait.start(0)
    generator = UpTo(gait)
    region = support_region(robot.sole, *stance, 0.005)
    return gait, generator, Transition(gait, generator), region


def tick(setting, wish, *, off_plan=False, timing=None, moving=True):
    gait, _, transition, region = setting
    transition.remember()
    if timing is not None:
        gait.retime(timing)
    state = PendulumState(0.0, 0.0)
    return transition.admit(state, region, wish, moving=moving, off_plan=off_plan)


def test_an_admitted_change_is_made_at_once(setting):
    tick(setting, SLOW)
    tick(setting, FAST)
    _, _, transition, _ = setting
    assert transition.fraction == 1.0
    assert transition.landing.x == pytest.approx(0.3 * TIME)


def test_bisection_takes_the_maximum_admitted_fraction(setting):
    _, generator, transition, _ = setting
    tick(setting, SLOW)
    slow = transition.landing.x
    fast = 3.0 * slow
    generator.reach = slow + 0.6 * (fast - slow)
    ramps = tick(setting, FAST)
    assert 0.6 - 0.5**BISECTIONS <= transition.fraction <= 0.6
    assert transition.landing.x == pytest.approx(slow + transition.fraction * (fast - slow))
    assert any(ramps is one for one in generator.arguments)
    assert transition.strides.right[0] == pytest.approx(transition.landing.x)


def test_if_nothing_is_admitted_the_old_plan_goes_on(setting):
    gait, generator, transition, _ = setting
    tick(setting, SLOW)
    before, clock = tick(setting, SLOW), gait.clock
    generator.reach = -1.0
    after = tick(setting, FAST, timing=Timing(20, 80, 0.03))
    assert transition.fraction == 0.0
    assert list(after) == list(before)
    assert gait.clock == clock


def test_timing_changes_by_the_same_fraction(setting):
    gait, generator, transition, _ = setting
    tick(setting, SLOW)
    generator.reach = 0.5 * (transition.landing.x + 3.0 * transition.landing.x) + 1e-9
    usual = gait.timing
    tick(setting, FAST, timing=Timing(14, 74, 0.025))
    assert transition.fraction == 0.5
    assert gait.timing.single == round(0.5 * (usual.single + 74))


class FromHere(UpTo):
    """Also, admits no walk that ends after a footstep shorter than `least`."""

    least = 0.0

    def admits(self, state, ramps, region):
        ends = len(ramps) < 2 * PARAMETERS.gait.preview_steps
        return super().admits(state, ramps, region) and not (
            ends and self.landing(ramps) < self.least
        )


def ending(setting):
    """The setting with a `FromHere` generator, in a fast walk."""
    gait, _, _, region = setting
    generator = FromHere(gait)
    setting = gait, generator, Transition(gait, generator), region
    tick(setting, FAST)
    return setting, generator, setting[2]


def test_a_walk_ends_by_the_shortest_footstep_from_which_it_can(setting):
    setting, generator, transition = ending(setting)
    fast = transition.landing.x
    generator.least = 0.3 * fast
    ramps = tick(setting, STILL, moving=False)
    assert not transition.moving
    assert transition.strides == STILL
    assert 0.3 * fast <= transition.landing.x <= (0.3 + 0.5**BISECTIONS) * fast
    assert any(ramps is one for one in generator.arguments)


def test_a_walk_that_cannot_end_yet_goes_on(setting):
    setting, generator, transition = ending(setting)
    generator.least = 2.0 * transition.landing.x
    tick(setting, STILL, moving=False)
    assert transition.moving


def test_without_a_plan_to_carry_on_the_wanted_one_is_taken(setting):
    gait, generator, transition, _ = setting
    tick(setting, SLOW)
    generator.reach, generator.lost = -1.0, True
    tick(setting, FAST, timing=Timing(20, 80, 0.03))
    assert transition.fraction == 1.0
    assert transition.landing.x == pytest.approx(0.3 * TIME)
    assert gait.timing == Timing(20, 80, 0.03)


def swinging(setting):
    gait = setting[0]
    while gait.swing_phase < 0.6:
        tick(setting, SLOW)
        gait.aim(setting[2].landing)
        gait.advance(moving=True)
    return gait


def test_a_foot_that_has_met_the_floor_is_where_it_is(setting):
    gait, _, transition, _ = setting
    swinging(setting)
    gait.touchdown()
    tick(setting, FAST)
    assert transition.landing == gait.landing


def test_during_a_capture_step_the_plan_keeps_its_landing(setting):
    gait, _, transition, _ = setting
    swinging(setting)
    kept = transition.landing
    gait.aim(Foothold(False, kept.x + 0.01, kept.y, 0.0))
    gait.touchdown()
    tick(setting, SLOW, off_plan=True)
    assert transition.landing == kept
