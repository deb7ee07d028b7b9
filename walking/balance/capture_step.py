"""The pendulum of the plan, and that of a body which has left the plan to be caught."""

from collections.abc import Sequence
from dataclasses import replace

from walking.foothold import Foothold
from walking.gait.gait import Gait
from walking.pattern.dcm_tracker import DcmTracker
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import PatternGenerator
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import SupportRegion


class CapturePendulum:
    """Two pendulums that are one unless a footstep is moved to catch the body.

    A generator that plans its ZMP cannot plan for footholds that a push dictates. While one
    does, its plan goes on beside, to tell how far the body is off; the body's pendulum tracks
    the DCM that leads to the foothold which is really aimed at. At touchdown both are one.

    Args:
        lipm: pendulum.
        generator: of the plan.
        gait: knows where the swing foot is really to land.
        gain: of the tracking [1].
        state: both begin here.

    Attributes:
        state: of the body's pendulum.
        planned: of the plan's; the same object while nothing is caught.
    """

    def __init__(
        self,
        lipm: Lipm,
        generator: PatternGenerator,
        gait: Gait,
        gain: float,
        state: PendulumState,
    ) -> None:
        self._lipm = lipm
        self._generator = generator
        self._gait = gait
        self._tracker = DcmTracker(lipm, gain)
        self.state = self.planned = state

    @property
    def off_plan(self) -> bool:
        """Whether the body has left the plan."""
        return self.planned is not self.state

    def advance(self, ramps: Sequence[ZmpRamp], landing: Foothold, region: SupportRegion) -> None:
        """One tick.

        Args:
            ramps: ZMP reference from now on.
            landing: of the plan.
            region: where the ZMP may be.
        """
        generator, gait, state = self._generator, self._gait, self.state
        if not generator.selective:
            generator.advance(state, ramps, region)
            return
        if gait.hurried:
            self._tracker.follow(state, ramps, region)
            return
        if (
            not (gait.landing is landing or gait.double or self.off_plan)
            and gait.landing != landing
        ):
            self.planned = replace(state)
        planned = self.planned
        if planned is state:
            generator.advance(state, ramps, region)
            return
        # The ZMP goes over to the new foothold from the old one, which does not move.
        c, w = self._lipm.ramp(gait.timing.double), self._lipm.omega
        share = (1.0 + c.last) / c.growth / self._lipm.ramp(gait.ticks_left).growth
        x = planned.x + planned.vx / w + share * (gait.landing.x - landing.x)
        y = planned.y + planned.vy / w + share * (gait.landing.y - landing.y)
        generator.advance(planned, ramps, region)
        self._tracker.advance(state, (x, y), (planned.zmp_x, planned.zmp_y), region)

    def touchdown(self) -> None:
        """After the gait's tick: the plan begins anew from where the body is."""
        if self.off_plan and (self._gait.double or not self._gait.stepping):
            self.reset_plan()

    def reset_plan(self) -> None:
        """Have no plan but the footholds."""
        self.planned = self.state
        self._generator.forget()
