"""Pattern generators: tracking, gains of preview control, and admission of plans."""

import numpy as np
import pytest

from walking.admission import admit, remember
from walking.footsteps import STILL, Foothold, foothold
from walking.gait import start, update_phase
from walking.parameters import PatternParameters
from walking.patterns import PLAN, advance_pattern, is_feasible, preview_gains, rejects_infeasible
from walking.pendulum import PENDULUM, dcm_of, dcm_reference
from walking.reference import BEST, LIVE, RAMP, set_ramp
from walking.support import clip, support_region
from walking.zmp_solver import KNOT

LEFT, RIGHT = Foothold(True, 0.0, 0.042, 0.0), Foothold(False, 0.0, -0.042, 0.0)
TRACKING = ["dcm", "preview"]
FAST = (0.1, -0.2, 0.0)


class Tracker:
    """Pendulum of a generator between two parallel feet."""

    def __init__(self, model, x, y, vy=0.0):
        self.model, self.pendulum = model, np.zeros(1, PENDULUM)[0]
        p = self.pendulum
        p.x, p.y, p.vy, p.zmp_x, p.zmp_y = x, y, vy, x, y
        self.region = support_region(model.robot.support, RIGHT, LEFT, 0.005)
        self.plans, self.knots = np.zeros(4, PLAN), np.zeros((4, 200), KNOT)

    def advance(self, ramps):
        live, model = self.plans[LIVE], self.model
        live.ramps[: len(ramps)], live.ramp_count = ramps, len(ramps)
        rest = (False, self.pendulum, self.region, model.robot, model.sums)
        advance_pattern(self.plans, self.knots, *rest)
        zmp = (self.pendulum.zmp_x, self.pendulum.zmp_y)
        assert clip(self.region, *zmp) == zmp


@pytest.mark.parametrize("name", TRACKING)
def test_a_displaced_pendulum_comes_to_rest_over_the_reference(make_model, name):
    tracker = Tracker(make_model(name), 0.02, 0.01, 0.05)
    assert not rejects_infeasible(tracker.model.robot)
    ramps = np.zeros(1, RAMP)
    set_ramp(ramps[0], 1, (0.01, 0.0), (0.01, 0.0), RIGHT, LEFT)
    for _ in range(400):
        tracker.advance(ramps)
    p = tracker.pendulum
    np.testing.assert_allclose([p.x, p.y, p.vx, p.vy], [0.01, 0.0, 0.0, 0.0], atol=2e-4)


@pytest.mark.parametrize("name", TRACKING)
def test_the_zmp_tracks_a_sideways_shift(make_model, name):
    tracker, ramps = Tracker(make_model(name), 0.01, 0.0), np.zeros(2, RAMP)
    for k in range(60):
        here = (0.01, 0.03 * k / 60)
        set_ramp(ramps[0], 60 - k, here, (0.01, 0.03), RIGHT, LEFT)
        set_ramp(ramps[1], 200, (0.01, 0.03), (0.01, 0.03), RIGHT, LEFT)
        tracker.advance(ramps)
    assert dcm_of(tracker.pendulum, tracker.model.robot)[1] == pytest.approx(0.03, abs=6e-3)


def test_preview_weights_fade_and_are_complete_within_the_horizon(model):
    omega = float(model.robot.omega)
    gains = preview_gains(omega, PatternParameters(preview_time=2.0))
    weights = np.diff(gains.sums["gain"])
    assert weights[0] > 0.0
    assert abs(weights[-1]) < 1e-4 * weights.max()
    assert gains.sums["gain"][-1] == pytest.approx(gains.total, rel=1e-3)
    moments = np.cumsum(weights * np.arange(1, len(weights) + 1))
    np.testing.assert_allclose(gains.sums["moment"][1:], moments, atol=1e-12)


class Admission:
    """Admission of plans by a generator, in the middle of the first single support."""

    def __init__(self, model, make_walk):
        self.model = model
        self.walk, self.plans = make_walk()
        self.knots = np.zeros((4, 200), KNOT)
        self.live = self.plans[LIVE]
        self.gait = self.live.gait
        start(self.gait, 0, True, model.robot)
        self.gait.tick = self.gait.clock.shift.end + 44
        update_phase(self.gait, model.robot)
        self.region = support_region(model.robot.support, LEFT, LEFT, 0.005)

    def on_reference(self, strides):
        """Put the pendulum on the DCM of a plan with these strides."""
        self.admit(strides)
        ramps, p = self.live.ramps[: self.live.ramp_count], self.walk.pendulum
        x, y = dcm_reference(ramps, self.model.robot)
        p.x, p.y, p.vx, p.vy = x, y, 0.0, 0.0
        p.zmp_x, p.zmp_y = ramps[0].ax, ramps[0].ay

    def admit(self, strides, *, moving=True):
        """Fraction of the wanted change."""
        walk = self.walk
        remember(walk.admission, self.gait)
        walk.steering.wanted, walk.steering.velocity[0] = strides, moving
        self.accepted = admit(walk, self.plans, self.knots, self.region, self.model.robot)
        return walk.admission.fraction

    def feasible(self):
        """Whether the plan in force is feasible by itself."""
        rest = (LIVE, self.walk.pendulum, self.region, self.model.robot)
        return is_feasible(self.plans.copy(), self.knots.copy(), *rest)


@pytest.fixture
def admission(model, make_walk):
    return Admission(model, make_walk)


def test_a_feasible_change_is_made_at_once(admission, strides_of):
    admission.on_reference(strides_of((0.1, 0.0, 0.0)))
    fraction = admission.admit(strides_of((0.12, 0.0, 0.0)))
    assert admission.accepted
    assert fraction == 1.0
    assert admission.feasible()


def test_a_change_that_is_too_large_is_made_in_part_and_stays_feasible(admission, strides_of):
    slow, fast = strides_of((0.1, 0.0, 0.0)), strides_of(FAST)
    admission.on_reference(slow)
    admission.admit(slow)
    live, best = admission.live.zmp, admission.plans[BEST].zmp
    live.exists, live.phases, live.count = True, best.phases, best.count
    for k in range(best.phases):
        live.supports[k] = best.supports[k]
    before, right = foothold(admission.live.landing), float(slow.right.y)
    fraction = admission.admit(fast)
    assert 0.0 <= fraction < 1.0
    assert admission.accepted == (fraction > 0.0)
    moved = right + fraction * (float(fast.right.y) - right)
    assert admission.live.following.right.y == pytest.approx(moved)
    if fraction == 0.0:
        assert foothold(admission.live.landing) == before
    else:
        assert admission.feasible()


def test_without_a_plan_to_keep_the_wanted_one_is_taken(admission, strides_of):
    slow, fast = strides_of((0.1, 0.0, 0.0)), strides_of((0.5, 0.2, 0.0))
    admission.on_reference(slow)
    admission.admit(slow)
    admission.walk.pendulum.vx += 3.0
    fraction = admission.admit(fast)
    assert not admission.accepted
    assert fraction == 1.0
    assert admission.live.following.right.x == fast.right.x


def test_a_plan_that_is_tried_changes_nothing_in_force(admission, strides_of):
    slow = strides_of((0.1, 0.0, 0.0))
    admission.on_reference(slow)
    admission.admit(slow)
    gait = admission.gait.copy()
    update_phase(gait, admission.model.robot)
    assert str(gait) == str(admission.gait)
    admission.admit(strides_of(STILL))
    assert admission.gait.clock.shift.item() == gait.clock.shift.item()
