"""Rows of one Rerun entity, sent in blocks: thirty times cheaper than one call per row."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import rerun as rr

TIMELINE = "sim_time"


class Channel:
    """One entity of the log.

    Args:
        stream: where it goes.
        path: the entity.
        columns: builds the columns from components, for example ``rr.Points3D.columns``.
    """

    def __init__(self, stream: rr.RecordingStream, path: str, columns: Callable[..., Any]) -> None:
        self._stream = stream
        self._path = path
        self._columns = columns
        self._times: list[float] = []
        self._lengths: list[int] = []
        self._components: dict[str, list[Any]] = {}

    def add(self, time: float, **components: Sequence[Any] | np.ndarray) -> None:
        """Add one row; every component has one element per instance, which may be none."""
        self._times.append(time)
        self._lengths.append(len(next(iter(components.values()))))
        for name, values in components.items():
            self._components.setdefault(name, []).append(values)

    def add_rows(self, times: Sequence[float], **components: np.ndarray) -> None:
        """Add a row at each of `times`; components have as many rows of as many instances."""
        for name, values in components.items():
            self._components.setdefault(name, []).append(values.reshape(-1, *values.shape[2:]))
        self._times += times
        self._lengths += [next(iter(components.values())).shape[1]] * len(times)

    def flush(self) -> None:
        """Send the rows added since the last flush."""
        if not self._times:
            return
        columns = self._columns(**{n: _joined(v) for n, v in self._components.items()})
        if any(length != 1 for length in self._lengths):
            columns = columns.partition(self._lengths)
        times = rr.TimeColumn(TIMELINE, duration=np.array(self._times))
        self._stream.send_columns(self._path, [times], columns)
        self._times.clear()
        self._lengths.clear()
        self._components.clear()


def _joined(rows: list[Any]) -> Any:
    if isinstance(rows[0], np.ndarray):
        return np.concatenate(rows)
    return [value for row in rows for value in row]
