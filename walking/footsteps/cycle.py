"""Two footsteps, one of either foot: the period of a walk."""


class Cycle:
    """Tells when the foot that carried first carries again.

    A sideways walk or a turn opens the stance with one foot and closes it with the other one;
    only over both does it go as it is told.
    """

    def __init__(self) -> None:
        self._first: int | None = None
        self._support: int | None = None

    def rest(self) -> None:
        """The robot stands; the foot that carries next is the first."""
        self._first = self._support = None

    def begins(self, support: int) -> bool:
        """Whether a cycle begins in this tick, in which foot `support` carries or is about to."""
        if self._first is None:
            self._first = support
        begins = support == self._first and support != self._support
        self._support = support
        return begins
