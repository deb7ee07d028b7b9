"""From the plan of the last tick to the one now wanted, as far as the ZMP allows."""

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

BISECTIONS = 4  # halvings: at most 1/16 short of the largest change that is admissible


@value
class Course:
    """All that a plan is made of.

    Attributes:
        landing: of the swing foot.
        strides: after it.
        clock: of the gait.
        moving: whether it goes on walking.
    """

    landing: Foothold
    strides: Strides
    clock: Clock
    moving: bool


class Transition:
    """Replaces a change that the generator does not admit by the largest share that it does.

    The share is found by bisection between the plan of the last tick, which the generator
    can always carry on, and the wanted one: landing, later strides and times change together
    (Lee & Kim, J. Electr. Eng. Technol. 9(1), 2014). After a disturbance the generator may have
    no plan to carry on; then the wanted one is taken for the generator to come as near to it as
    it can.

    A walk that is to end takes the shortest footstep after which the next one can close the
    stance: whatever else bends, the body would get farther on its way and take more footsteps.

    Args:
        gait: holds the times.
        generator: judges the plans.

    Attributes:
        share: of the wanted change made in this tick, 0 … 1 [1].
        landing: of the admitted plan.
        moving: whether the admitted plan goes on walking.
        strides: of the admitted plan.
    """

    def __init__(self, gait: Gait, generator: PatternGenerator) -> None:
        self._gait = gait
        self._generator = generator
        self._stepping = gait.stepping
        self._footstep = gait.completed
        self._clock = gait.clock
        self.share = 1.0
        self.landing = gait.landing
        self.moving = False
        self.strides: Strides | None = None

    def remember(self) -> None:
        """Keep the times of the last tick, before anything about them changes."""
        self._stepping, self._clock = self._gait.stepping, self._gait.clock

    def skip(self, strides: Strides, *, moving: bool) -> None:
        """Strides of a plan that nobody has to admit."""
        self.share, self.strides, self.moving = 1.0, strides, moving

    def admit(
        self,
        state: PendulumState,
        region: SupportRegion,
        wish: Strides,
        *,
        moving: bool,
        off_plan: bool = False,
    ) -> Ramps:
        """Reference of the admitted plan; the gait has its times.

        Args:
            state: of the pendulum.
            region: where the ZMP may be in this tick.
            wish: strides of the wanted plan.
            moving: whether the wanted plan goes on walking.
            off_plan: whether the swing foot makes a capture step that leaves this plan.
        """
        gait = self._gait
        continues = self._stepping and gait.stepping and gait.completed == self._footstep
        self._footstep = gait.completed
        if not continues or (gait.held and not off_plan):
            self.landing = gait.landing
        aimed = gait.aimed(self.landing, gait.nominal(wish)) if gait.adjustable else self.landing
        ramps = gait.plan(aimed, wish, moving=moving)
        before = self.strides
        changes = self._stepping and gait.stepping
        if before is None or not changes or self._generator.admits(state, ramps, region):
            self.share, self.landing, self.moving, self.strides = 1.0, aimed, moving, wish
            return ramps
        wanted = Course(aimed, wish, gait.clock, moving)
        old = Course(self.landing, before, self._clock, self.moving)
        ending = None if moving else self._end(state, region, old, wanted)
        if ending is not None:
            return ending
        kept = self._plan(old)
        if self._generator.holds(kept):
            return self._bisect(state, region, old, wanted)
        return self._take(wanted, self._plan(wanted), 1.0)

    def _end(
        self, state: PendulumState, region: SupportRegion, old: Course, wanted: Course
    ) -> Ramps | None:
        """Reference of a walk that ends after the next footstep, None if it cannot yet."""

        def course(share: float) -> Course:
            return replace(wanted, landing=_landing(old.landing, wanted.landing, share))

        longest = course(0.0)
        ramps = self._plan(longest)
        if not self._generator.admits(state, ramps, region):
            return None
        found = self._largest(state, region, course)
        if found is None:
            self._plan(longest)
            found = self._take(longest, ramps, 0.0)
        return found

    def _bisect(
        self, state: PendulumState, region: SupportRegion, old: Course, wanted: Course
    ) -> Ramps:
        gait = self._gait

        def course(share: float) -> Course:
            gait.set_clock(old.clock)
            gait.retime(old.clock.timing.towards(wanted.clock.timing, share))
            return Course(
                _landing(old.landing, wanted.landing, share),
                old.strides.towards(wanted.strides, share),
                gait.clock,
                old.moving,
            )

        return self._largest(state, region, course) or self._take(old, self._plan(old), 0.0)

    def _largest(
        self, state: PendulumState, region: SupportRegion, course: Callable[[float], Course]
    ) -> Ramps | None:
        """Reference of the course with the largest share that the generator admits, if any."""
        low, high = 0.0, 1.0
        best = None
        for _ in range(BISECTIONS):
            share = 0.5 * (low + high)
            tried = course(share)
            trial = self._plan(tried)
            if self._generator.admits(state, trial, region):
                low, best = share, (tried, trial)
            else:
                high = share
        if best is None:
            return None
        self._plan(best[0])
        return self._take(*best, low)

    def _plan(self, course: Course) -> Ramps:
        self._gait.set_clock(course.clock)
        return self._gait.plan(course.landing, course.strides, moving=course.moving)

    def _take(self, course: Course, ramps: Ramps, share: float) -> Ramps:
        self.share, self.landing = share, course.landing
        self.moving, self.strides = course.moving, course.strides
        return ramps


def _landing(a: Foothold, b: Foothold, share: float) -> Foothold:
    """A landing `share` of the way from `a` to `b`."""
    return Foothold(
        left=b.left,
        x=a.x + share * (b.x - a.x),
        y=a.y + share * (b.y - a.y),
        yaw=a.yaw + share * (b.yaw - a.yaw),
    )
