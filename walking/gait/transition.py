"""Transition from the last plan to the wanted one, as far as the ZMP constraints allow."""

from collections.abc import Callable
from dataclasses import replace

from walking.foothold import Foothold
from walking.footsteps.stride import Strides
from walking.gait.footstep_clock import Clock
from walking.gait.gait import Gait
from walking.pattern.pattern import PatternGenerator
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import Ramps
from walking.pattern.support import SupportRegion
from walking.value import value

BISECTIONS = 4  # at most 1/16 short of the maximum admissible change


@value
class StepPlan:
    """Footsteps of a plan.

    Attributes:
        landing: of the swing foot.
        strides: of the footsteps after it.
        clock: of the gait.
        moving: whether the walk goes on.
    """

    landing: Foothold
    strides: Strides
    clock: Clock
    moving: bool


class Transition:
    """Limits a change of plan to the maximum fraction that the pattern generator admits.

    Bisection between the last plan, which stays feasible, and the wanted one; landing, later
    strides and timing change together (Lee & Kim, J. Electr. Eng. Technol. 9(1), 2014). After a
    disturbance the last plan may be infeasible, too; then the generator approximates the wanted
    one.

    A walk that ends takes the shortest footstep after which the next one can close the stance:
    any other compromise takes the body farther and costs more footsteps.

    Args:
        gait: holds the timing.
        generator: checks the plans.

    Attributes:
        fraction: of the wanted change admitted in this tick, 0 to 1 [1].
        landing: of the admitted plan.
        moving: whether the walk goes on in the admitted plan.
        strides: of the admitted plan.
    """

    def __init__(self, gait: Gait, generator: PatternGenerator) -> None:
        self._gait = gait
        self._generator = generator
        self._stepping = gait.stepping
        self._footstep = gait.completed
        self._clock = gait.clock
        self.fraction = 1.0
        self.landing = gait.landing
        self.moving = False
        self.strides: Strides | None = None

    def remember(self) -> None:
        """Store the timing of the last tick before it changes."""
        self._stepping, self._clock = self._gait.stepping, self._gait.clock

    def skip(self, strides: Strides, *, moving: bool) -> None:
        """Take a plan that needs no admission."""
        self.fraction, self.strides, self.moving = 1.0, strides, moving

    def admit(
        self,
        state: PendulumState,
        region: SupportRegion,
        wanted: Strides,
        *,
        moving: bool,
        off_plan: bool = False,
    ) -> Ramps:
        """Return the ZMP reference of the admitted plan and give the gait its timing.

        Args:
            state: of the pendulum.
            region: admissible ZMP in this tick.
            wanted: strides of the wanted plan.
            moving: whether the walk goes on in the wanted plan.
            off_plan: whether the swing foot makes a capture step that leaves this plan.
        """
        gait = self._gait
        continues = self._stepping and gait.stepping and gait.completed == self._footstep
        self._footstep = gait.completed
        if not continues or (gait.landed_early and not off_plan):
            self.landing = gait.landing
        aimed = gait.aimed(self.landing, gait.nominal(wanted)) if gait.adjustable else self.landing
        ramps = gait.plan(aimed, wanted, moving=moving)
        before = self.strides
        changes = self._stepping and gait.stepping
        if before is None or not changes or self._generator.admits(state, ramps, region):
            self.fraction, self.landing, self.moving, self.strides = 1.0, aimed, moving, wanted
            return ramps
        goal = StepPlan(aimed, wanted, gait.clock, moving)
        old = StepPlan(self.landing, before, self._clock, self.moving)
        ending = None if moving else self._end(state, region, old, goal)
        if ending is not None:
            return ending
        kept = self._plan(old)
        if self._generator.holds(kept):
            return self._bisect(state, region, old, goal)
        return self._take(goal, self._plan(goal), 1.0)

    def _end(
        self, state: PendulumState, region: SupportRegion, old: StepPlan, goal: StepPlan
    ) -> Ramps | None:
        """Return the reference of a walk that ends after the next footstep, None if infeasible."""

        def step_plan(fraction: float) -> StepPlan:
            return replace(goal, landing=old.landing.towards(goal.landing, fraction))

        shortest = step_plan(0.0)
        ramps = self._plan(shortest)
        if not self._generator.admits(state, ramps, region):
            return None
        admitted = self._max_change(state, region, step_plan)
        if admitted is None:
            self._plan(shortest)
            admitted = self._take(shortest, ramps, 0.0)
        return admitted

    def _bisect(
        self, state: PendulumState, region: SupportRegion, old: StepPlan, goal: StepPlan
    ) -> Ramps:
        gait = self._gait

        def step_plan(fraction: float) -> StepPlan:
            gait.set_clock(old.clock)
            gait.retime(old.clock.timing.towards(goal.clock.timing, fraction))
            return StepPlan(
                old.landing.towards(goal.landing, fraction),
                old.strides.towards(goal.strides, fraction),
                gait.clock,
                old.moving,
            )

        return self._max_change(state, region, step_plan) or self._take(old, self._plan(old), 0.0)

    def _max_change(
        self, state: PendulumState, region: SupportRegion, step_plan: Callable[[float], StepPlan]
    ) -> Ramps | None:
        """Return the reference of the plan with the maximum admitted fraction, if any."""
        low, high = 0.0, 1.0
        best = None
        for _ in range(BISECTIONS):
            fraction = 0.5 * (low + high)
            candidate = step_plan(fraction)
            ramps = self._plan(candidate)
            if self._generator.admits(state, ramps, region):
                low, best = fraction, (candidate, ramps)
            else:
                high = fraction
        if best is None:
            return None
        self._plan(best[0])
        return self._take(*best, low)

    def _plan(self, plan: StepPlan) -> Ramps:
        self._gait.set_clock(plan.clock)
        return self._gait.plan(plan.landing, plan.strides, moving=plan.moving)

    def _take(self, plan: StepPlan, ramps: Ramps, fraction: float) -> Ramps:
        self.fraction, self.landing = fraction, plan.landing
        self.moving, self.strides = plan.moving, plan.strides
        return ramps
