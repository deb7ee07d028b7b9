"""Wall times counted by size: their quantiles in a bounded memory, however long the run."""

from array import array
from math import exp, log

SHORTEST, LONGEST = 1e-6, 100.0  # what is shorter or longer counts in the first or last bin [s]
RATIO = 1.01  # of the two edges of a bin [1]

_SCALE = 1.0 / log(RATIO)
_OFFSET = log(SHORTEST)
BINS = int((log(LONGEST) - _OFFSET) * _SCALE) + 1


class TimeHistogram:
    """Mean and greatest of many durations exactly, their quantiles to one percent.

    Attributes:
        count: durations so far.
        total: their sum [s].
        greatest: of them [s].
    """

    __slots__ = ("_bins", "count", "greatest", "total")

    def __init__(self) -> None:
        self.count, self.total, self.greatest = 0, 0.0, 0.0
        self._bins = array("q", bytes(8 * BINS))

    def add(self, seconds: float) -> None:
        """Take one duration."""
        self.count += 1
        self.total += seconds
        self.greatest = max(self.greatest, seconds)
        number = int((log(seconds) - _OFFSET) * _SCALE) if seconds > SHORTEST else 0
        self._bins[min(number, BINS - 1)] += 1

    @property
    def mean(self) -> float:
        """Mean [s]; of none, 0."""
        return self.total / self.count if self.count else 0.0

    def quantile(self, share: float) -> float:
        """Least duration that `share` of all do not exceed, too long by a bin at most [s]."""
        if not self.count:
            return 0.0
        left = share * self.count
        for number, count in enumerate(self._bins[:-1]):
            left -= count
            if left <= 0.0 and count:
                return min(exp(_OFFSET + (number + 1) / _SCALE), self.greatest)
        return self.greatest
