"""Pendulums of the plan and of the body during a capture step."""

from collections.abc import Sequence
from dataclasses import replace

from walking.foothold import Foothold
from walking.gait.gait import Gait
from walking.pattern.dcm_pattern import DcmGenerator
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import PatternGenerator
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import SupportRegion


class CapturePendulum:
    """Pendulum of the body, separate from that of the plan during a capture step.

    A generator that plans its ZMP cannot plan for footholds that a push dictates. During a capture
    step its plan continues as the reference of the DCM error, and the pendulum of the body tracks
    the DCM that leads to the actual landing. At touchdown the two become one.

    Args:
        lipm: pendulum.
        generator: of the plan.
        gait: holds the actual landing.
        gain: of DCM tracking [1].
        state: initial state.

    Attributes:
        state: pendulum of the body.
        planned: pendulum of the plan; the object `state` unless off plan.
    """

    def __init__(
        self, lipm: Lipm, generator: PatternGenerator, gait: Gait, gain: float, state: PendulumState
    ) -> None:
        self._lipm = lipm
        self._generator = generator
        self._gait = gait
        self._tracker = DcmGenerator(lipm, gain)
        self.state = self.planned = state

    @property
    def off_plan(self) -> bool:
        """Whether the body follows another pendulum than the plan."""
        return self.planned is not self.state

    def advance(self, ramps: Sequence[ZmpRamp], landing: Foothold, region: SupportRegion) -> None:
        """Advance the pendulums by one tick.

        Args:
            ramps: ZMP reference from now on.
            landing: of the plan.
            region: admissible ZMP.
        """
        generator, gait, state = self._generator, self._gait, self.state
        if not generator.selective:
            generator.advance(state, ramps, region)
            return
        if gait.shortened:
            self._tracker.advance(state, ramps, region)
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
        # Shift of the DCM by a ramp of the ZMP from the fixed support foot to the new landing.
        c = self._lipm.ramp(gait.timing.double)
        weight = (1.0 + c.last) / c.growth / self._lipm.ramp(gait.ticks_left).growth
        x, y = planned.dcm(self._lipm.omega)
        x += weight * (gait.landing.x - landing.x)
        y += weight * (gait.landing.y - landing.y)
        generator.advance(planned, ramps, region)
        self._tracker.track(state, (x, y), planned.zmp, region)

    def touchdown(self) -> None:
        """At touchdown, restart the plan from the pendulum of the body."""
        if self.off_plan and (self._gait.double or not self._gait.stepping):
            self.reset_plan()

    def reset_plan(self) -> None:
        """Drop the plan of the generator."""
        self.planned = self.state
        self._generator.forget()
