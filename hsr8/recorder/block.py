"""Buffers a second of records and handles them in one batch, which halves the cost.

The code stays in the processor's caches.
"""

from hsr8.recorder.record import TickRecord

PERIOD = 1.0  # of a block; a killed run loses so much of its records at most [s]


class Block:
    """Records that have not been worked off.

    Args:
        period: from the first of them to the last [s].
    """

    __slots__ = ("_begin", "_period", "_records")

    def __init__(self, period: float = PERIOD) -> None:
        self._period = period
        self._begin = 0.0
        self._records: list[TickRecord] = []

    def add(self, record: TickRecord) -> bool:
        """Take one record.

        Returns:
            Whether it is time to `take` them all.
        """
        if not self._records:
            self._begin = record.time
        self._records.append(record)
        return record.time - self._begin >= self._period - 1e-9

    def take(self) -> list[TickRecord]:
        """All records since the last call; they wait no longer."""
        records, self._records = self._records, []
        return records
