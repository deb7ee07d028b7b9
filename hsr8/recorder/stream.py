"""Files of tables: Arrow IPC streams, one compressed batch per second.

The file `CHECKSUMS` has a line for each batch: table, rows and bytes of its file up to the end of
the batch, and the CRC-32 of the bytes of the batch. Only bytes that match their checksum, and
whose unpacked size is bounded, are passed to Arrow, which allocates the memory that a file states.
A file that is cut off at any byte loses its last batch only.
"""

import io
import os
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import pyarrow as pa

from hsr8.errors import UsageError
from hsr8.files.regular import read_text, require_regular
from hsr8.files.writing import writing
from hsr8.recorder.columns import Row, batch_of, schema_of
from hsr8.recorder.table import Table
from hsr8.recorder.unpacked_size import rows_and_size

SUFFIX = ".arrows"
CHECKSUMS = "checksums.txt"
WRITE = pa.ipc.IpcWriteOptions(compression="lz4", use_threads=False)  # zstd: 7 % less, 6x as slow
MAX_PART = 64_000_000  # of a batch; that of a second has 0.2 MB [byte]
MAX_ROWS = 1_000_000  # of a batch
MAX_UNPACKED, MAX_RATIO = 256_000_000, 16  # of a table: constant [byte] and per byte of the file
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
        UsageError: the file cannot be read, is damaged, or is not a table of this kind.
    """
    if not os.path.lexists(path):
        return Table(path.stem, schema_of(row).empty_table())
    try:
        require_regular(path)
        content = _verified(path, _checksums(path.parent / CHECKSUMS), whole=whole)
        if not content:
            return Table(path.stem, schema_of(row).empty_table())
        with pa.ipc.open_stream(content, options=READ) as reader:
            _require_types(reader.schema, schema_of(row))
            arrow = pa.Table.from_batches(reader, reader.schema)
        arrow.validate(full=True)
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror or error}") from error
    except (pa.ArrowException, ValueError) as error:
        raise UsageError(f"{path}: not a table of a run: {_first_line(error)}") from error
    return Table(path.stem, arrow)


def _checksums(file: Path) -> list[str]:
    """Return the lines of the file of checksums."""
    try:
        return read_text(file).splitlines(keepends=True)
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise UsageError(f"cannot read {file}: {reason}") from error


def _verified(path: Path, lines: Sequence[str], *, whole: bool) -> bytearray:
    """Return the batches of a file that match their checksums and the bounds of their sizes."""
    content, count, unpacked, checksums = bytearray(), 0, 0, path.parent / CHECKSUMS
    with path.open("rb") as file:
        for line in lines:
            name, *numbers = line.split(" ")
            if name != path.stem or not line.endswith("\n"):
                continue
            try:
                last, end, checksum = int(numbers[0]), int(numbers[1]), int(numbers[2], 16)
            except (ValueError, IndexError) as error:
                raise UsageError(f"{checksums}: damaged line {line.strip()!r}") from error
            size, rows = end - len(content), last - count
            if not (0 <= size <= MAX_PART and 0 <= rows <= MAX_ROWS):
                raise UsageError(f"{checksums}: out of range in line {line.strip()!r}")
            part = file.read(size)
            if len(part) < size:
                break
            if zlib.crc32(part) != checksum:
                raise UsageError(f"{path}: damaged in rows {count} to {last}")
            unpacked += _unpacked(part, rows)
            content += part
            if unpacked > MAX_UNPACKED + MAX_RATIO * len(content):
                raise ValueError(f"{len(content)} bytes unpack to {unpacked}")
            count = last
        else:
            whole = False
    if whole:
        raise UsageError(f"{path}: cut off after {count} rows")
    return content


def _unpacked(part: bytes, rows: int) -> int:
    """Return the unpacked size of the batches of a part [byte]."""
    messages = pa.ipc.MessageReader.open_stream(pa.BufferReader(part))
    batches = [rows_and_size(message) for message in messages if message.type != "schema"]
    if any(count < 0 for count, _ in batches) or sum(count for count, _ in batches) != rows:
        raise ValueError("another number of rows than in its checksums")
    return sum(size for _, size in batches)


def _require_types(schema: pa.Schema, expected: pa.Schema) -> None:
    """Require columns of the expected types, apart from the sizes of arrays.

    Raises:
        ValueError: a column has another type.
    """
    for field in schema:
        position = expected.get_field_index(field.name)
        if position < 0 or not _same_type(field.type, expected.field(position).type):
            raise ValueError(f"column {field.name!r} of type {field.type}")


def _same_type(one: pa.DataType, other: pa.DataType) -> bool:
    if pa.types.is_list(one) or pa.types.is_fixed_size_list(one):
        return one.id == other.id and _same_type(one.value_type, other.value_type)
    if pa.types.is_struct(one) and pa.types.is_struct(other):
        names = [field.name for field in one] == [field.name for field in other]
        return names and all(_same_type(a.type, b.type) for a, b in zip(one, other, strict=True))
    return bool(one.equals(other))


def _first_line(error: Exception) -> str:
    return str(error).partition("\n")[0]
