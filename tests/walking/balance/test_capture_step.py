"""Pendulums of plan and body during a capture step."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from walking.balance.capture_step import CapturePendulum
from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.footsteps.stride import Timing
from walking.pattern.dcm_pattern import dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import TrackingGenerator
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import support_region

LIPM = Lipm(0.19)
FOOT, LANDING = Foothold(True, 0.0, 0.042, 0.0), Foothold(False, 0.05, -0.042, 0.0)
REGION = support_region(Sole(centre=0.01, half_length=0.0525, half_width=0.03), FOOT, FOOT, 0.005)
ZMP = (0.012, 0.04)  # of the plan in this tick
DOUBLE, LEFT = 14, 30


class Plan(TrackingGenerator):
    """Generator with a constant planned ZMP, independent of the reference."""

    selective = True

    def __init__(self):
        self.forgotten = 0

    def advance(self, state, ramps, region):
        state.step(LIPM, ZMP, region)

    def forget(self):
        self.forgotten += 1


def reference(landing):
    """Of the rest of a single support, and a footstep onto a landing; the ZMP is in its middle."""
    (ax, ay), (bx, by) = (FOOT.x + 0.01, FOOT.y), (landing.x + 0.01, landing.y)
    return [
        ZmpRamp(LEFT, ax, ay, ax, ay, (FOOT, FOOT)),
        ZmpRamp(DOUBLE, ax, ay, bx, by, (FOOT, landing)),
        ZmpRamp(54, bx, by, bx, by, (landing, landing)),
    ]


def beyond(dx, dy):
    return replace(LANDING, x=LANDING.x + dx, y=LANDING.y + dy)


def capture(state, landing, plan=None, **changes):
    timing = Timing(DOUBLE, 54, 0.025)
    usual = {"shortened": False, "double": False, "stepping": True, "ticks_left": LEFT}
    gait = SimpleNamespace(**(usual | {"landing": landing, "timing": timing} | changes))
    return CapturePendulum(LIPM, plan or Plan(), gait, 2.5, state), gait


def test_a_walk_that_lands_where_it_is_planned_has_one_pendulum():
    state, alone = PendulumState(0.01, 0.03, 0.1, 0.05), PendulumState(0.01, 0.03, 0.1, 0.05)
    pendulum, _ = capture(state, replace(LANDING))  # another foothold, the same place
    pendulum.advance(reference(LANDING), LANDING, REGION)
    Plan().advance(alone, [], REGION)
    assert not pendulum.off_plan
    assert pendulum.planned is pendulum.state is state
    assert state == alone


@pytest.mark.parametrize("move", [(0.03, 0.0), (0.0, -0.02), (-0.02, 0.01)])
def test_the_plan_goes_on_and_the_body_is_led_to_the_other_foothold(move):
    """On the DCM of the plan, moved as the footholds move it, a body needs the plan's own ZMP."""
    planned, other = reference(LANDING), reference(beyond(*move))
    start = PendulumState(0.01, 0.03, 0.1, 0.05)
    pendulum, _ = capture(replace(start), beyond(*move))
    pendulum.advance(planned, LANDING, REGION)
    assert pendulum.off_plan
    alone = replace(start)
    Plan().advance(alone, planned, REGION)
    assert pendulum.planned == alone
    one, two = dcm_reference(LIPM, planned), dcm_reference(LIPM, other)
    body = pendulum.state
    before = replace(pendulum.planned)
    body.x = before.x + before.vx / LIPM.omega - body.vx / LIPM.omega + two[0] - one[0]
    body.y = before.y + before.vy / LIPM.omega - body.vy / LIPM.omega + two[1] - one[1]
    pendulum.advance(planned, LANDING, REGION)
    assert (body.zmp_x, body.zmp_y) == pytest.approx(ZMP)


def test_a_shortened_footstep_has_no_plan():
    state = PendulumState(*dcm_reference(LIPM, reference(LANDING)))
    pendulum, _ = capture(state, LANDING, shortened=True)
    pendulum.advance(reference(LANDING), LANDING, REGION)
    assert not pendulum.off_plan
    # On the DCM of the footholds, its ZMP is theirs.
    assert (state.zmp_x, state.zmp_y) == pytest.approx((0.01, FOOT.y))


@pytest.mark.parametrize("lands", [{"double": True}, {"stepping": False}])
def test_at_touch_down_both_are_one_again(lands):
    plan = Plan()
    pendulum, gait = capture(PendulumState(0.01, 0.03), beyond(0.03, 0.0), plan)
    pendulum.advance(reference(LANDING), LANDING, REGION)
    pendulum.touchdown()
    assert pendulum.off_plan
    vars(gait).update(lands)
    pendulum.touchdown()
    assert pendulum.planned is pendulum.state
    assert plan.forgotten == 1


def test_in_double_support_nothing_is_caught():
    pendulum, _ = capture(PendulumState(0.01, 0.03), beyond(0.03, 0.0), double=True)
    pendulum.advance(reference(LANDING), LANDING, REGION)
    assert not pendulum.off_plan
