"""What is taken of many moments that follow one another: at most one in so much time."""

from math import inf


class Throttle:
    """Tells which moments to take.

    Args:
        period: between two of them at least [s].
    """

    __slots__ = ("_last", "_period")

    def __init__(self, period: float) -> None:
        self._period = period
        self._last = -inf

    def due(self, time: float) -> bool:
        """Whether to take the moment `time` [s]; the next one must be later by the period."""
        if time - self._last < self._period - 1e-9:
            return False
        self._last = time
        return True
