"""Gait cycle: two footsteps, one with each foot."""


class GaitCycle:
    """Detects the begin of a gait cycle.

    A sideways walk or a turn opens the stance with one foot and closes it with the other one;
    only the mean over both is the commanded velocity.
    """

    def __init__(self) -> None:
        self._first: int | None = None
        self._support: int | None = None

    def reset(self) -> None:
        """Restart with the next support foot."""
        self._first = self._support = None

    def begins(self, support: int) -> bool:
        """Whether a cycle begins in this tick with support foot `support`."""
        if self._first is None:
            self._first = support
        begins = support == self._first and support != self._support
        self._support = support
        return begins
