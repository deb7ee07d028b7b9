"""Histogram of wall times: quantiles in bounded memory, however long the run."""

from array import array
from math import exp, log

SHORTEST, LONGEST = 1e-6, 100.0  # shorter and longer times count in the first and last bin [s]
RATIO = 1.01  # of the two edges of a bin [1]

_SCALE = 1.0 / log(RATIO)
_OFFSET = log(SHORTEST)
BINS = int((log(LONGEST) - _OFFSET) * _SCALE) + 1


class TimeHistogram:
    """Exact mean and maximum of many durations, quantiles to one percent.

    Attributes:
        count: number of durations.
        total: their sum [s].
        max: longest duration [s].
    """

    __slots__ = ("_bins", "count", "max", "total")

    def __init__(self) -> None:
        self.count, self.total, self.max = 0, 0.0, 0.0
        self._bins = array("q", bytes(8 * BINS))

    def add(self, seconds: float) -> None:
        """Count one duration."""
        self.count += 1
        self.total += seconds
        self.max = max(self.max, seconds)
        number = int((log(seconds) - _OFFSET) * _SCALE) if seconds > SHORTEST else 0
        self._bins[min(number, BINS - 1)] += 1

    @property
    def mean(self) -> float:
        """Mean [s]; 0 without durations."""
        return self.total / self.count if self.count else 0.0

    def quantile(self, fraction: float) -> float:
        """Return the duration that `fraction` of all do not exceed, up to one bin too long [s]."""
        if not self.count:
            return 0.0
        left = fraction * self.count
        for number, count in enumerate(self._bins[:-1]):
            left -= count
            if left <= 0.0 and count:
                return min(exp(_OFFSET + (number + 1) / _SCALE), self.max)
        return self.max
