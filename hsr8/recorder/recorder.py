"""Recorder: writes the tables of a run as it happens, one batch per second."""

import errno
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any, Self

from hsr8.files.writing import writing
from hsr8.frame_record import FrameRecord
from hsr8.record import Tick
from hsr8.recorder.log_level import LogRates
from hsr8.recorder.recorded import FrameSampler, RecordedImage, image_row, objects_of
from hsr8.recorder.rows import TABLES
from hsr8.recorder.stream import CHECKSUMS, TableWriter
from hsr8.recorder.table import Table
from hsr8.recorder.throttle import Throttle

Tables = dict[str, Table]

PERIOD = 200  # ticks of a batch: a killed run loses at most one second


class Recorder:
    """Writer of the tables of a run, see `hsr8.recorder.rows`.

        with Recorder(folder, joints) as recorder:
            for tick in simulation:
                recorder.append(tick)

    Args:
        folder: of the run; it exists.
        joints: names of the joints.
        scale: of the world [1].
        images: rate and quality of the recorded images; None for no images.
        listeners: receive every batch of tables, those without new rows left out.
        period: ticks of a batch.

    Raises:
        RecordingFailed: in every method, the folder cannot be written.
    """

    def __init__(
        self,
        folder: Path,
        joints: Sequence[str],
        *,
        scale: float = 1.0,
        images: LogRates | None = None,
        listeners: Sequence[Callable[[Tables], None]] = (),
        period: int = PERIOD,
    ) -> None:
        self._folder = folder
        self._period = period
        self._listeners = listeners
        self._sampler = FrameSampler(scale)
        self._images = images
        self._throttle = Throttle(images.frame if images else 0.0)
        with writing(folder):
            self._checksums = (folder / CHECKSUMS).open("wb")
        labels = {"joints": joints}
        self._writers = {
            name: TableWriter(folder, name, rows, labels, self._checksums)
            for name, rows in TABLES.items()
        }
        self._ticks: list[Tick] = []
        self._encoder = ThreadPoolExecutor(1)  # of images, while the other tables are written

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Write the remaining rows and close the files."""
        with writing(self._folder), ExitStack() as stack:
            stack.callback(self._checksums.close)
            stack.callback(self._encoder.shutdown)
            for writer in self._writers.values():
                stack.callback(writer.close)
            self._write()

    @property
    def rows(self) -> dict[str, int]:
        """Number of rows of each table so far."""
        return {name: writer.count for name, writer in self._writers.items()}

    def append(self, tick: Tick) -> None:
        """Record one control tick."""
        self._ticks.append(tick)
        if len(self._ticks) >= self._period:
            self._write()

    def _write(self) -> None:
        ticks, self._ticks = self._ticks, []
        if not ticks:
            return
        with writing(self._folder):
            if not self._folder.exists():  # open files outlive their folder
                raise FileNotFoundError(errno.ENOENT, "the folder was removed")
        tables = {
            name: self._writers[name].write(rows)
            for name, objects in self._objects_of(ticks).items()
            if (rows := [*objects])
        }
        for listener in self._listeners:
            listener(tables)

    def _objects_of(self, ticks: Sequence[Tick]) -> dict[str, Iterable[Any]]:
        """Return the recorded objects of each table."""
        objects = objects_of(ticks, self._sampler)
        return {**objects, "images": self._image_rows([f.frame for f in objects["frames"]])}

    def _image_rows(self, frames: Sequence[FrameRecord]) -> Iterable[RecordedImage]:
        """Return the rows of images, which are compressed in another thread."""
        if self._images is None or not self._images.jpeg:
            return ()
        due = [f for f in frames if f.image is not None and self._throttle.due(f.time)]
        return self._encoder.map(partial(image_row, quality=self._images.jpeg), due)
