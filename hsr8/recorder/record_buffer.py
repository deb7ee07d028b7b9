"""Buffer of records: work done once a second in one batch keeps code in the caches."""

from hsr8.record import TickRecord

PERIOD = 1.0  # a killed run loses at most this much of its records [s]


class RecordBuffer:
    """Records that are still to be written or evaluated.

    Args:
        period: from the first record in the buffer to the last [s].
    """

    __slots__ = ("_begin", "_period", "_records")

    def __init__(self, period: float = PERIOD) -> None:
        self._period = period
        self._begin = 0.0
        self._records: list[TickRecord] = []

    def add(self, record: TickRecord) -> bool:
        """Append a record and return whether the buffer is due to be emptied by `take`."""
        if not self._records:
            self._begin = record.time
        self._records.append(record)
        return record.time - self._begin >= self._period - 1e-9

    def take(self) -> list[TickRecord]:
        """Remove and return all records."""
        records, self._records = self._records, []
        return records
