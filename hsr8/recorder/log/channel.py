"""Rows of Rerun entities, sent in batches: thirty times cheaper than one call per row."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import rerun as rr

TIMELINE = "sim_time"


class Stream(Protocol):
    """Recording that a channel belongs to."""

    def add_channel(self, channel: "Channel") -> None:
        """Send the rows of `channel` from now on."""

    def log(self, path: str, archetype: Any, *, static: bool) -> None:
        """Log one archetype."""


class Channel:
    """Rows of one entity.

    Args:
        stream: recording.
        path: of the entity.
        archetype: Rerun's archetype, for example ``rr.Points3D``.
        style: components that never change.
    """

    def __init__(self, stream: Stream, path: str, archetype: Any, **style: Any) -> None:
        self._path = path
        self._columns = archetype.columns
        self._times: list[float] = []
        self._counts: list[int] = []
        self._components: dict[str, list[Any]] = {}
        stream.add_channel(self)
        if style:
            stream.log(path, archetype.from_fields(**style), static=True)

    def add(self, time: float, **components: Sequence[Any] | np.ndarray) -> None:
        """Add one row; every component has one element per instance, or none."""
        self.add_rows([time], [len(next(iter(components.values())))], **components)

    def add_rows(
        self,
        times: Sequence[float],
        counts: Sequence[int],
        /,
        **components: Sequence[Any] | np.ndarray,
    ) -> None:
        """Add a row at each of `times`.

        Args:
            times: of the rows [s].
            counts: number of instances of each row.
            components: one element per instance, row by row.
        """
        if not len(times):
            return
        self._times += times
        self._counts += counts
        for name, values in components.items():
            self._components.setdefault(name, []).append(values)

    def send(self, stream: rr.RecordingStream) -> None:
        """Send all rows and remove them."""
        if not self._times:
            return
        components = {name: _joined(rows) for name, rows in self._components.items()}
        times = rr.TimeColumn(TIMELINE, duration=np.array(self._times))
        rows = self._columns(**components).partition(self._counts)
        rr.send_columns(self._path, [times], rows, recording=stream)
        self._times, self._counts, self._components = [], [], {}


def _joined(rows: list[Any]) -> Any:
    if isinstance(rows[0], np.ndarray):
        return np.concatenate(rows)
    return [value for row in rows for value in row]
