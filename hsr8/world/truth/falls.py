"""Fall counter: a fall lasts until the robot stays on its feet."""

RECOVERY_TIME = 1.0  # upright time after which a fall is over [s]


class Falls:
    """Counts the falls of a run.

    Failed attempts to get up belong to the same fall.

    Attributes:
        count: falls so far.
    """

    def __init__(self) -> None:
        self._last_fallen: float | None = None
        self.count = 0

    def add(self, time: float, *, fallen: bool) -> bool:
        """Add one record at `time` [s] and return whether a fall begins with it."""
        begins = fallen and not self.lasting(time)
        if fallen:
            self._last_fallen = time
        self.count += begins
        return begins

    def lasting(self, time: float) -> bool:
        """Return whether a fall lasts at `time` [s]."""
        return self._last_fallen is not None and time - self._last_fallen < RECOVERY_TIME
