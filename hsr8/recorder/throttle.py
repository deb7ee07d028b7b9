"""Throttle: pass at most one sample per interval."""

from math import inf

import numpy as np
from numpy.typing import NDArray


class Throttle:
    """Selection of samples by time.

    Args:
        period: minimum interval between two samples [s].
    """

    __slots__ = ("_last", "_period")

    def __init__(self, period: float) -> None:
        self._period = period
        self._last = -inf

    def select(self, times: NDArray[np.float64]) -> NDArray[np.intp]:
        """Return the indices of the samples at `times` (n,) [s] that pass."""
        due = [k for k, time in enumerate(times.tolist()) if self.due(time)]
        return np.array(due, dtype=np.intp)

    def due(self, time: float) -> bool:
        """Return whether the sample at `time` [s] passes."""
        if time - self._last < self._period - 1e-9:
            return False
        self._last = time
        return True
