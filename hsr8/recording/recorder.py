"""Recorder: passes the tables of a run to its sinks as it happens, one batch per second."""

from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import pyarrow as pa

from hsr8.recording.columns import batch_of, schema_of
from hsr8.recording.recorded import FrameSampler, RecordedImage, Throttle, image_row, objects_of
from hsr8.recording.rows import TABLES
from hsr8.recording.table import Table
from hsr8.simulation.decisions import FrameRecord
from hsr8.simulation.record import Tick

Tables = dict[str, Table]

PERIOD = 200  # ticks of a batch: a killed run loses at most one second


@dataclass(frozen=True, slots=True)
class ImageRates:
    """Images of the head camera that a run keeps.

    Attributes:
        period: minimum interval between two images [s].
        quality: quality of the compression [%].
    """

    period: float
    quality: int


IMAGES = {"none": None, "standard": ImageRates(0.18, 75), "full": ImageRates(0.0, 90)}
"""Rates by the scenario's key ``recorder.images``."""


class Sink(Protocol):
    """Receiver of the tables of a run: a folder or a log."""

    def add(self, tables: Tables) -> None:
        """Take a batch of rows; tables without new rows are left out."""

    def close(self, exit_reason: str) -> None:
        """End: no rows follow."""


class Recorder:
    """Recorder of the ticks of a run, see `hsr8.recording.rows`; close it.

    Args:
        joints: names of the joints.
        sinks: receivers of the tables, closed in the reverse order.
        scale: scale of the world [1].
        images: rate and quality of the recorded images; None for no images.
        period: ticks of a batch.

    Raises:
        RecordingFailed: in every method, a sink cannot write.
    """

    def __init__(
        self,
        joints: Sequence[str],
        sinks: Sequence[Sink],
        *,
        scale: float = 1.0,
        images: ImageRates | None = None,
        period: int = PERIOD,
    ) -> None:
        self._labels = {"joints": joints}
        self._sinks = sinks
        self._period = period
        self._sampler = FrameSampler(scale)
        self._images = images
        self._throttle = Throttle(images.period if images else 0.0)
        self._schemas: dict[str, pa.Schema] = {}
        self._ticks: list[Tick] = []
        self._encoder = ThreadPoolExecutor(1)  # of images, while the other tables are made

    def append(self, tick: Tick) -> None:
        """Record one control tick."""
        self._ticks.append(tick)
        if len(self._ticks) >= self._period:
            self._pass_on()

    def close(self, exit_reason: str) -> None:
        """Record the remaining ticks and close all sinks."""
        with ExitStack() as stack:
            for sink in self._sinks:
                stack.callback(sink.close, exit_reason)
            stack.callback(self._encoder.shutdown)
            self._pass_on()

    def _pass_on(self) -> None:
        """Pass the rows of the collected ticks to the sinks."""
        ticks, self._ticks = self._ticks, []
        objects = objects_of(ticks, self._sampler)
        images = self._image_rows([frame.frame for frame in objects["frames"]])
        tables = {
            name: self._table(name, rows)
            for name, parts in {**objects, "images": images}.items()
            if (rows := [*parts])
        }
        if tables:
            for sink in self._sinks:
                sink.add(tables)

    def _table(self, name: str, objects: Sequence[Any]) -> Table:
        if name not in self._schemas:
            self._schemas[name] = schema_of(TABLES[name], objects, self._labels)
        batch = batch_of(TABLES[name], objects, self._schemas[name])
        return Table(name, pa.Table.from_batches([batch]))

    def _image_rows(self, frames: Sequence[FrameRecord]) -> Iterable[RecordedImage]:
        """Return the rows of images, which are compressed in another thread."""
        if self._images is None:
            return ()
        due = [f for f in frames if f.image is not None and self._throttle.due(f.time)]
        return self._encoder.map(partial(image_row, quality=self._images.quality), due)
