"""Counters of walking, updated in every control tick because records are rarer."""

from array import array
from collections import Counter
from math import inf
from typing import Protocol

from walking.command_limits import Limit

ROUNDING = 1e-9  # of a ZMP on the edge of the sole [m]


class Countable(Protocol):
    """The part of the walking engine that the counters read."""

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Constraints that limited the command."""

    @property
    def zmp_depth(self) -> float:
        """Distance of the planned ZMP from the edge of the soles, positive inside [m]."""


class WalkCounters:
    """Counts since the start of a run.

    Attributes:
        ticks: control ticks counted.
        limited: ticks in which the command was limited.
        by_limit: ticks in which each limit was active.
        zmp_outside: ticks with the planned ZMP outside the soles.
        min_zmp_depth: smallest depth of the planned ZMP inside the soles [m].
        wall_times: of the walking ticks [s].
    """

    __slots__ = ("by_limit", "limited", "min_zmp_depth", "ticks", "wall_times", "zmp_outside")

    def __init__(self) -> None:
        self.ticks = self.limited = self.zmp_outside = 0
        self.by_limit: Counter[Limit] = Counter()
        self.min_zmp_depth = inf
        self.wall_times = array("d")

    def add(self, walking: Countable, seconds: float) -> None:
        """Count one tick, which took `seconds` of wall time."""
        self.ticks += 1
        self.wall_times.append(seconds)
        limits = walking.limits
        if limits:
            self.limited += 1
            for limit in dict.fromkeys(limits):  # several parts may report the same limit
                self.by_limit[limit] += 1
        depth = float(walking.zmp_depth)  # a NumPy number where no kernel is compiled
        self.min_zmp_depth = min(self.min_zmp_depth, depth)
        self.zmp_outside += depth < -ROUNDING
