"""Falls counted as people count them: one lasts until the robot stays on its feet."""

RECOVERED = 1.0  # a robot that has not lain for so long has got up [s]


class Falls:
    """Counts the falls of a run.

    On its way up the robot kneels and squats, and may fail and lie again: all of that is the
    same fall.

    Attributes:
        count: falls so far.
    """

    def __init__(self) -> None:
        self._lay_at: float | None = None
        self.count = 0

    def add(self, time: float, *, fallen: bool) -> bool:
        """Take one record.

        Args:
            time: of it [s].
            fallen: whether the robot lies.

        Returns:
            whether a fall begins with it.
        """
        begins = fallen and not self.lasting(time)
        if fallen:
            self._lay_at = time
        self.count += begins
        return begins

    def lasting(self, time: float) -> bool:
        """Whether a fall is under way at `time` [s]."""
        return self._lay_at is not None and time - self._lay_at < RECOVERED
