"""What is counted in every control tick of walking, records being rarer."""

from collections import Counter
from math import inf
from typing import Protocol

from hsr8.recorder.time_histogram import TimeHistogram
from walking.admission import Limit


class Countable(Protocol):
    """What the tally asks of the walking engine."""

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that altered the command."""

    @property
    def zmp_depth(self) -> float:
        """How far inside the soles the planned ZMP lies [m]."""


class WalkTally:
    """Counts since the start of a run.

    Attributes:
        ticks: control ticks counted.
        altered: of them, those whose command was altered.
        by_limit: of them, those in which each limit bound.
        outside: of them, those with the planned ZMP outside the soles.
        least_depth: least distance of the planned ZMP to the edge of the soles [m].
        wall: wall times of the walking ticks.
    """

    __slots__ = ("altered", "by_limit", "least_depth", "outside", "ticks", "wall")

    def __init__(self) -> None:
        self.ticks = self.altered = self.outside = 0
        self.by_limit: Counter[Limit] = Counter()
        self.least_depth = inf
        self.wall = TimeHistogram()

    def add(self, walking: Countable, seconds: float) -> None:
        """Take the tick just made, which took `seconds` of wall time."""
        self.ticks += 1
        self.wall.add(seconds)
        limits = walking.limits
        if limits:
            self.altered += 1
            for limit in dict.fromkeys(limits):  # several parts may tell of the same
                self.by_limit[limit] += 1
        depth = float(walking.zmp_depth)  # NumPy's where no kernel is compiled
        self.least_depth = min(self.least_depth, depth)
        self.outside += depth < -ROUNDING


ROUNDING = 1e-9  # of a ZMP on the very edge [m]
