"""Files of tables: Arrow IPC streams, one compressed batch per second.

The file `CHECKSUMS` has a line for each batch: table, rows and bytes of its file up to the end of
the batch, and the CRC-32 of the bytes of the batch. Arrow does not check its input, and a
damaged file may crash it: only bytes that match their checksum are passed to Arrow. A file that is
cut off at any byte loses its last batch only.
"""

import io
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import pyarrow as pa

from hsr8.errors import UsageError
from hsr8.recorder.columns import Row, batch_of, schema_of
from hsr8.recorder.files.writing import writing
from hsr8.recorder.table import Table

SUFFIX = ".arrows"
CHECKSUMS = "checksums.txt"
WRITE = pa.ipc.IpcWriteOptions(compression="lz4", use_threads=False)  # zstd: 7 % less, 6x as slow
READ = pa.ipc.IpcReadOptions(use_threads=False)  # threads take ten times as long for many batches


class TableWriter:
    """Writer of one table; the file is created with the first rows.

    Args:
        folder: of the run.
        name: of the table.
        row: its columns.
        labels: names of the elements of each named dimension, such as the joints.
        checksums: open file of the checksums.

    Attributes:
        count: number of rows.

    Raises:
        RecordingFailed: in every method, the file cannot be written.
    """

    def __init__(
        self,
        folder: Path,
        name: str,
        row: Row,
        labels: Mapping[str, Sequence[str]],
        checksums: BinaryIO,
    ) -> None:
        self._folder = folder
        self._name = name
        self._row = row
        self._labels = labels
        self._checksums = checksums
        self._sink = io.BytesIO()  # joins the many small pieces that Arrow writes
        self._file: io.FileIO | None = None
        self._size = 0
        self.count = 0

    def write(self, objects: Sequence[Any]) -> Table:
        """Append recorded objects, at least one, and return their rows as a table."""
        with writing(self._folder):
            if self._file is None:
                self._schema = schema_of(self._row, objects, self._labels)
                self._file = io.FileIO(self._folder / f"{self._name}{SUFFIX}", "w")
                self._writer = pa.ipc.new_stream(self._sink, self._schema, options=WRITE)
            batch = batch_of(self._row, objects, self._schema)
            self._writer.write_batch(batch)
            self.count += len(objects)
            self._write_part(self._file)
        return Table(self._name, pa.Table.from_batches([batch]))

    def close(self) -> None:
        """End the stream and close the file."""
        if self._file is None or self._file.closed:
            return
        with writing(self._folder), self._file:
            self._writer.close()
            self._write_part(self._file)

    def _write_part(self, file: io.FileIO) -> None:
        """Write the bytes since the last call and their checksum."""
        part = rest = self._sink.getvalue()
        self._sink.seek(0)
        self._sink.truncate()
        try:
            while rest:  # a disk that is nearly full takes some of the bytes
                rest = rest[file.write(rest) :]
        except OSError:
            file.close()  # nothing follows a part that is cut off
            raise
        self._size += len(part)
        line = f"{self._name} {self.count} {self._size} {zlib.crc32(part):08x}\n"
        self._checksums.write(line.encode())
        self._checksums.flush()


def read_table(path: Path, row: Row, *, whole: bool) -> Table:
    """Read a table; one without a file has no rows.

    Args:
        path: file.
        row: its columns.
        whole: refuse a file that is cut off, which that of a killed run may be.

    Raises:
        UsageError: the file cannot be read or is damaged.
    """
    if not path.exists():
        return Table(path.stem, schema_of(row).empty_table())
    try:
        content = path.read_bytes()
        lines = (path.parent / CHECKSUMS).read_text().splitlines(keepends=True)
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"cannot read {path}: {error}") from error
    count, size = 0, 0
    for line in lines:
        name, *numbers = line.split(" ")
        if name != path.stem or not line.endswith("\n"):
            continue
        try:
            last, end, checksum = int(numbers[0]), int(numbers[1]), int(numbers[2], 16)
        except (ValueError, IndexError) as error:
            raise UsageError(f"{path.parent / CHECKSUMS}: damaged line {line!r}") from error
        if end > len(content):
            break
        if zlib.crc32(content[size:end]) != checksum:
            raise UsageError(f"{path}: damaged in rows {count} to {last}")
        count, size = last, end
    else:
        whole = False
    if whole:
        raise UsageError(f"{path}: cut off after {count} rows")
    if not size:
        return Table(path.stem, schema_of(row).empty_table())
    with pa.ipc.open_stream(content[:size], options=READ) as reader:
        return Table(path.stem, pa.Table.from_batches(reader, reader.schema))
