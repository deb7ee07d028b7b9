"""Admission of plans by the modifiable pattern generator."""

from math import exp

import pytest

from walking.parameters import CONTROL_PERIOD
from walking.plan.admission import admit_modified, remember
from walking.plan.footsteps import landing_of, put
from walking.plan.gait import start, support_foot
from walking.plan.mwpg import admits_target, walking_target
from walking.plan.reference import plan_walk
from walking.plan.support import support_region

FAST = (0.1, -0.2, 0.0)


class Admission:
    """Admission of plans by a generator, in the middle of the first single support."""

    def __init__(self, model, make_walk, elapsed=10):
        self.model = model
        self.walk = make_walk()
        self.live = self.walk.plan
        self.gait = self.live.gait
        start(self.gait, 0, True, model.robot)
        self.gait.tick = self.gait.clock.shift.end + elapsed
        self.region = support_region(model.robot.support, *2 * [support_foot(self.gait)], 0.005)

    @property
    def ramps(self):
        return self.live.ramps[: self.live.ramp_count]

    def on_reference(self, strides):
        """Put plan and pendulum on the periodic walk with these strides."""
        robot, p = self.model.robot, self.walk.pendulum
        landing = landing_of(support_foot(self.gait), strides)
        plan_walk(self.live, landing, strides, True, robot)
        put(self.gait.landing, landing)
        ramps = self.ramps
        w, target = float(robot.omega), walking_target(ramps, robot)
        growth = exp(w * ramps[0].ticks * CONTROL_PERIOD)
        p.zmp_x, p.zmp_y = ramps[0].ax, ramps[0].ay
        # Under a ZMP at rest the one component grows, the other one decays.
        (xi_x, xi_y), (zeta_x, zeta_y) = target.xi, target.zeta
        p.x = p.zmp_x + 0.5 * (xi_x / growth + zeta_x * growth)
        p.y = p.zmp_y + 0.5 * (xi_y / growth + zeta_y * growth)
        p.vx = 0.5 * w * (xi_x / growth - zeta_x * growth)
        p.vy = 0.5 * w * (xi_y / growth - zeta_y * growth)

    def admit(self, strides, *, moving=True):
        """Fraction of the wanted change."""
        walk = self.walk
        remember(walk)
        walk.steering.wanted, walk.steering.velocity.vx = strides, moving
        admit_modified(walk, self.region, self.model.robot)
        return walk.admission.fraction

    def feasible(self):
        """Whether the plan in force is feasible by itself."""
        rest = (self.walk.pendulum, self.ramps, self.region, self.model.robot)
        return admits_target(self.walk.functions.copy(), *rest)


@pytest.fixture
def admission(make_model, make_walk):
    return Admission(make_model("mwpg"), make_walk)


def test_a_feasible_change_is_made_at_once(admission, strides_of):
    admission.on_reference(strides_of((0.1, 0.0, 0.0)))
    fraction = admission.admit(strides_of((0.12, 0.0, 0.0)))
    assert fraction == 1.0
    assert admission.feasible()


def test_a_change_that_is_too_late_is_made_in_part_and_stays_feasible(
    make_model, make_walk, strides_of
):
    admission = Admission(make_model("mwpg"), make_walk, elapsed=35)
    slow, fast = strides_of((0.1, 0.0, 0.0)), strides_of(FAST)
    admission.on_reference(slow)
    admission.admit(slow)
    right, timing = float(slow.right.y), admission.gait.clock.timing.item()
    fraction = admission.admit(fast)
    assert 0.0 < fraction < 1.0
    assert admission.gait.clock.timing.item() == timing  # that of both plans
    moved = right + fraction * (float(fast.right.y) - right)
    assert admission.live.following.right.y == pytest.approx(moved)
    assert admission.feasible()


def test_without_a_plan_to_keep_the_wanted_one_is_taken(admission, strides_of):
    slow, fast = strides_of((0.1, 0.0, 0.0)), strides_of((0.5, 0.2, 0.0))
    admission.on_reference(slow)
    admission.admit(slow)
    admission.walk.pendulum.vx += 3.0
    admission.walk.functions.missed_x = 0.1
    fraction = admission.admit(fast)
    assert fraction == 1.0
    assert admission.live.following.right.x == fast.right.x
