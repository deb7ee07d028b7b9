"""The clock of one footstep: the weight goes over to the support foot, then the other swings."""

from dataclasses import replace
from typing import NamedTuple

from walking.footsteps.stride import Timing
from walking.value import comparable_value, value

Point = tuple[float, float]


@comparable_value
class WeightShift:
    """ZMP and weight on their way to where they are meant to stay, linear in time.

    Attributes:
        begin, end: control ticks since the begin of the footstep [1].
        zmp: at `begin` [m].
        right_weight: share of the weight on the right foot at `begin` [1].
    """

    begin: int
    end: int
    zmp: Point
    right_weight: float

    def share(self, tick: int) -> float:
        """How much of the way is made at a tick [1]."""
        return min(1.0, (tick - self.begin) / (self.end - self.begin))

    def zmp_at(self, tick: int, goal: Point) -> Point:
        """ZMP at a tick on its way to `goal` [m]."""
        share = self.share(tick)
        (ox, oy), (gx, gy) = self.zmp, goal
        return ox + share * (gx - ox), oy + share * (gy - oy)

    def right_weight_at(self, tick: int, goal: float) -> float:
        """Share of the weight on the right foot at a tick, on its way to `goal` [1]."""
        return self.right_weight + self.share(tick) * (goal - self.right_weight)


@value
class SwingWindow:
    """What part of single support the foot is in the air.

    Attributes:
        first, last: shares of single support [1].
        shortest: control ticks that a foot in the air is left to come down [1].
    """

    first: float
    last: float
    shortest: int

    def single_support(self, ticks: int) -> "SingleSupport":
        """A single support of so many control ticks."""
        return SingleSupport(ticks, round(self.first * ticks), round(self.last * ticks))

    def retimed(self, single: "SingleSupport", elapsed: int, ticks: int) -> "SingleSupport":
        """A single support that began `elapsed` ticks ago made to last `ticks` altogether.

        The swing goes on from where it is; it lasts longer where the foot could not come down.
        """
        phase = single.phase(elapsed)
        while round(self.last * ticks) < elapsed + self.shortest:
            ticks += 1
        anew = self.single_support(ticks)
        if phase > 0.0 or elapsed > anew.first:
            return replace(anew, first=elapsed, origin=phase)
        return anew


@comparable_value
class SingleSupport:
    """Times of a single support in control ticks since its begin.

    Attributes:
        ticks: its duration [1].
        first, last: between which the foot swings; `first` is now if retimed in the air [1].
        origin: phase of the swing at `first` [1].
    """

    ticks: int
    first: int
    last: int
    origin: float = 0.0

    def phase(self, elapsed: int) -> float:
        """Progress of the swing, 0 before and 1 after it [1]."""
        share = (elapsed - self.first) / (self.last - self.first)
        phase = self.origin + (1.0 - self.origin) * share
        return 0.0 if phase < 0.0 else 1.0 if phase > 1.0 else phase


class Clock(NamedTuple):
    """All times of a gait.

    Attributes:
        timing: of the footsteps to come.
        shift: of the weight in this footstep.
        single: support of this footstep.
    """

    timing: Timing
    shift: WeightShift
    single: SingleSupport
