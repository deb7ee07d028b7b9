"""From the plan of the last tick to the one now wanted, as far as the ZMP allows."""

from walking.gait import Gait
from walking.pattern import PatternGenerator, PendulumState, ZmpRamp
from walking.state import Footstep
from walking.stride import Strides
from walking.support import SupportRegion

BISECTIONS = 4  # an admitted change is at least 1/16 short of the largest possible


class Transition:
    """Replaces a change that the generator does not admit by the largest share that it does.

    The share is found by bisection between the plan of the last tick, which the generator
    can always carry on, and the wanted one: landing, later strides and times change together
    (Lee & Kim, J. Electr. Eng. Technol. 9(1), 2014).

    Args:
        gait: holds landing and times.
        generator: judges the plans.

    Attributes:
        share: of the wanted change made in this tick, 0 … 1 [1].
        moving: whether the admitted plan goes on walking.
        strides: of the admitted plan.
    """

    def __init__(self, gait: Gait, generator: PatternGenerator) -> None:
        self._gait = gait
        self._generator = generator
        self._stepping, self._held = gait.stepping, gait.held
        self._landing = gait.landing
        self._clock = gait.clock()
        self.share = 1.0
        self.moving = False
        self.strides: Strides | None = None

    def remember(self) -> None:
        """Keep the plan of the last tick, before anything about it changes."""
        gait = self._gait
        self._stepping, self._held = gait.stepping, gait.held
        self._landing = gait.landing
        self._clock = gait.clock()

    def admit(
        self,
        state: PendulumState,
        ramps: list[ZmpRamp],
        region: SupportRegion,
        wish: Strides,
        *,
        moving: bool,
        forced: bool,
    ) -> list[ZmpRamp]:
        """Reference of the admitted plan; the gait has its landing and times.

        Args:
            state: of the pendulum.
            ramps: reference of the wanted plan.
            region: where the ZMP may be in this tick.
            wish: strides of the wanted plan.
            moving: whether the wanted plan goes on walking.
            forced: whether the landing has to change, because the body has left the old plan.
        """
        before = self.strides
        free = before is None or not self._stepping or not self._gait.stepping
        if before is None or free or self._generator.admits(state, ramps, region):
            self.share, self.moving, self.strides = 1.0, moving, wish
            return ramps
        landing, clock = self._gait.landing, self._gait.clock()
        if forced or (self._gait.held and not self._held):
            # The landing is as it is; at least nothing else adds to it.
            self.share, self.strides = 0.0, before
            self._gait.set_clock(self._clock)
            return self._plan(landing, before, 1.0)
        low, high, best = 0.0, 1.0, ramps
        for _ in range(BISECTIONS):
            share = 0.5 * (low + high)
            self._gait.set_clock(self._clock)
            self._gait.retime(self._clock[0].towards(clock[0], share))
            trial = self._plan(landing, before.towards(wish, share), share)
            if self._generator.admits(state, trial, region):
                low, best = share, trial
            else:
                high = share
        self.share, self.strides = low, before.towards(wish, low)
        self._gait.set_clock(self._clock)
        if low == 0.0:
            return self._plan(landing, before, 0.0)
        self._gait.retime(self._clock[0].towards(clock[0], low))
        self._plan(landing, self.strides, low)
        return best

    def _plan(self, landing: Footstep, strides: Strides, share: float) -> list[ZmpRamp]:
        old = self._landing
        self._gait.landing = Footstep(
            left=landing.left,
            x=old.x + share * (landing.x - old.x),
            y=old.y + share * (landing.y - old.y),
            yaw=old.yaw + share * (landing.yaw - old.yaw),
        )
        return self._gait.plan(self._gait.landing, strides, moving=self.moving)
