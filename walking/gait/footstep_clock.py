"""Timing of a footstep: weight shift in double support, swing in single support."""

from dataclasses import replace
from typing import NamedTuple

from walking.arrays import Point
from walking.footsteps.stride import Timing
from walking.value import comparable_value, value


@comparable_value
class WeightShift:
    """Linear shift of ZMP and weight to the support foot.

    Attributes:
        begin, end: control ticks since the begin of the footstep [1].
        zmp: at `begin` [m].
        right_weight: load fraction of the right foot at `begin` [1].
    """

    begin: int
    end: int
    zmp: Point
    right_weight: float

    def fraction(self, tick: int) -> float:
        """Return the progress at a tick [1]."""
        return min(1.0, (tick - self.begin) / (self.end - self.begin))

    def zmp_at(self, tick: int, goal: Point) -> Point:
        """Return the ZMP at a tick, given its goal [m]."""
        fraction = self.fraction(tick)
        (ox, oy), (gx, gy) = self.zmp, goal
        return ox + fraction * (gx - ox), oy + fraction * (gy - oy)

    def right_weight_at(self, tick: int, goal: float) -> float:
        """Return the load fraction of the right foot at a tick, given its goal [1]."""
        return self.right_weight + self.fraction(tick) * (goal - self.right_weight)


@value
class SwingWindow:
    """Swing interval within single support.

    Attributes:
        first, last: lift-off and touchdown as fractions of single support [1].
        min_ticks: minimum control ticks of a foot in the air until touchdown [1].
    """

    first: float
    last: float
    min_ticks: int

    def single_support(self, ticks: int) -> "SingleSupport":
        """Return a single support of a duration in control ticks."""
        return SingleSupport(ticks, round(self.first * ticks), round(self.last * ticks))

    def retimed(self, single: "SingleSupport", elapsed: int, ticks: int) -> "SingleSupport":
        """Change the total duration of a single support that began `elapsed` ticks ago.

        The swing continues from its present phase, and takes at least the minimum ticks.
        """
        phase = single.phase(elapsed)
        while round(self.last * ticks) < elapsed + self.min_ticks:
            ticks += 1
        retimed = self.single_support(ticks)
        if phase > 0.0 or elapsed > retimed.first:
            return replace(retimed, first=elapsed, origin=phase)
        return retimed


@comparable_value
class SingleSupport:
    """Timing of a single support in control ticks since its begin.

    Attributes:
        ticks: duration [1].
        first, last: begin and end of the swing; `first` is the present if retimed in the air [1].
        origin: phase of the swing at `first` [1].
    """

    ticks: int
    first: int
    last: int
    origin: float = 0.0

    def phase(self, elapsed: int) -> float:
        """Return the phase of the swing, 0 before and 1 after it [1]."""
        fraction = (elapsed - self.first) / (self.last - self.first)
        phase = self.origin + (1.0 - self.origin) * fraction
        return 0.0 if phase < 0.0 else 1.0 if phase > 1.0 else phase


class Clock(NamedTuple):
    """Timing of a gait.

    Attributes:
        timing: of the next footsteps.
        shift: of the weight in this footstep.
        single: single support of this footstep.
    """

    timing: Timing
    shift: WeightShift
    single: SingleSupport
