"""Files of tables: Arrow IPC streams, one compressed batch per second.

The file `CHECKSUMS` has a line for each batch: table, rows and bytes of its file up to the end of
the batch, and the CRC-32 of the bytes of the batch. Only bytes that match their checksum, and
whose unpacked size is bounded, are passed to Arrow, which allocates the memory that a file states.
A file that is cut off at any byte loses its last batch only.
"""

import errno
import io
import os
import struct
import zlib
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyarrow as pa

from hsr8.errors import UsageError
from hsr8.files.regular import read_text, require_regular
from hsr8.files.writing import writing
from hsr8.recorder.columns import Row, schema_of
from hsr8.recorder.rows import TABLES
from hsr8.recorder.table import Table

SUFFIX = ".arrows"
CHECKSUMS = "checksums.txt"
WRITE = pa.ipc.IpcWriteOptions(compression="lz4", use_threads=False)  # zstd: 7 % less, 6x as slow
MAX_PART = 64_000_000  # of a batch; that of a second has 0.2 MB [byte]
MAX_ROWS = 1_000_000  # of a batch
MAX_UNPACKED, MAX_RATIO = 256_000_000, 16  # of a table: constant [byte] and per byte of the file
READ = pa.ipc.IpcReadOptions(use_threads=False)  # threads take ten times as long for many batches
# Metadata of a record batch, a flatbuffer, see ``format/Message.fbs`` of the Arrow project. A table
# starts with the distance to its vtable, which has the offset of every field, 0 if it is absent.
HEADER, RECORD_BATCH = 2, 3  # field of the header of a message, and its type for a batch
LENGTH, BUFFERS, COMPRESSION = 0, 2, 3  # fields of a record batch
CODEC, LZ4 = 0, 0  # field of a compression, and its value
MAX_BLOCK_RATIO = 255  # of LZ4: a byte of a compressed block holds at most 255 bytes
UNCOMPRESSED = -1  # in place of the unpacked size of a buffer


class ArrowFiles:
    """Sink of a recorder that writes a file per table.

    Args:
        folder: folder of the run; it exists.

    Attributes:
        rows: number of rows of each table so far.

    Raises:
        RecordingFailed: in every method, a file cannot be written.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._writers: dict[str, _TableWriter] = {}
        self._checksums: BinaryIO | None = None

    @property
    def rows(self) -> dict[str, int]:
        """Number of rows of each table so far."""
        return {**dict.fromkeys(TABLES, 0), **{n: w.count for n, w in self._writers.items()}}

    def add(self, tables: Mapping[str, Table]) -> None:
        """Append rows."""
        with writing(self._folder):
            if not self._folder.exists():  # open files outlive their folder
                raise FileNotFoundError(errno.ENOENT, "the folder was removed")
            if self._checksums is None:
                self._checksums = (self._folder / CHECKSUMS).open("wb")
            for name, table in tables.items():
                if name not in self._writers:
                    file = self._folder / f"{name}{SUFFIX}"
                    self._writers[name] = _TableWriter(file, table.arrow.schema, self._checksums)
                self._writers[name].write(table.arrow)

    def close(self) -> None:
        """End the streams and close the files."""
        with writing(self._folder), ExitStack() as stack:
            if self._checksums is not None:
                stack.callback(self._checksums.close)
            for writer in self._writers.values():
                stack.callback(writer.close)


class _TableWriter:
    """Writer of one table.

    Args:
        path: path of the file, which is created.
        schema: columns.
        checksums: open file of the checksums.

    Attributes:
        count: number of rows.

    Raises:
        OSError: in every method, the file cannot be written.
    """

    def __init__(self, path: Path, schema: pa.Schema, checksums: BinaryIO) -> None:
        self._name = path.stem
        self._checksums = checksums
        self._file = io.FileIO(path, "w")
        self._sink = io.BytesIO()  # joins the many small pieces that Arrow writes
        self._writer = pa.ipc.new_stream(self._sink, schema, options=WRITE)
        self._size = 0
        self.count = 0

    def write(self, rows: pa.Table) -> None:
        """Append rows."""
        self._writer.write_table(rows)
        self.count += len(rows)
        self._write_part()

    def close(self) -> None:
        """End the stream and close the file."""
        if self._file.closed:
            return
        with self._file:
            self._writer.close()
            self._write_part()

    def _write_part(self) -> None:
        """Write the bytes since the last call and their checksum."""
        part = rest = self._sink.getvalue()
        self._sink.seek(0)
        self._sink.truncate()
        try:
            while rest:  # a disk that is nearly full takes some of the bytes
                rest = rest[self._file.write(rest) :]
        except OSError:
            self._file.close()  # nothing follows a part that is cut off
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
    except OSError as error:
        raise UsageError(f"cannot read {file}: {error.strerror}") from error


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


def rows_and_size(message: pa.Message) -> tuple[int, int]:
    """Return the number of rows of a record batch and the size of its unpacked buffers [byte].

    They follow from the metadata, before Arrow allocates memory for the buffers.

    Args:
        message: message of the batch.

    Raises:
        ValueError: the metadata does not fit the body, for example because a buffer cannot
            hold its unpacked size.
    """
    try:
        return _rows_and_size(memoryview(message.metadata), memoryview(message.body))
    except (struct.error, IndexError) as error:
        raise ValueError("invalid metadata") from error


def _rows_and_size(metadata: memoryview, body: memoryview) -> tuple[int, int]:
    root = _follow(metadata, 0)
    kind, header = (_field(metadata, root, field) for field in (HEADER - 1, HEADER))
    if kind is None or header is None or metadata[kind] != RECORD_BATCH:
        raise ValueError("not a record batch")
    batch = _follow(metadata, header)
    length, compression = (_field(metadata, batch, field) for field in (LENGTH, COMPRESSION))
    rows = 0 if length is None else int(struct.unpack_from("<q", metadata, length)[0])
    buffers = _buffers(metadata, batch)
    starts, sizes = buffers[:, 0], buffers[:, 1]
    if (starts < 0).any() or (sizes < 0).any() or (starts + sizes > len(body)).any():
        raise ValueError("a buffer is outside of the body")
    if compression is None:
        return rows, int(sizes.sum())
    codec = _field(metadata, _follow(metadata, compression), CODEC)
    if codec is not None and metadata[codec] != LZ4:
        raise ValueError("another compression than LZ4")
    total = 0
    for start, size in buffers[sizes > 0].tolist():
        (unpacked,) = struct.unpack_from("<q", body, start)
        unpacked = size if unpacked == UNCOMPRESSED else unpacked
        if not 0 <= unpacked <= MAX_BLOCK_RATIO * size:
            raise ValueError(f"{size} bytes cannot hold {unpacked}")
        total += unpacked
    return rows, total


def _buffers(metadata: memoryview, batch: int) -> np.ndarray:
    """Return start and size of every buffer in the body (n, 2) [byte]."""
    field = _field(metadata, batch, BUFFERS)
    if field is None:
        return np.zeros((0, 2), np.int64)
    vector = _follow(metadata, field)
    (count,) = struct.unpack_from("<I", metadata, vector)
    if vector + 4 + 16 * count > len(metadata):
        raise IndexError(count)
    numbers = np.frombuffer(metadata, "<i8", 2 * count, vector + 4)
    return numbers.reshape(count, 2)


def _follow(metadata: memoryview, index: int) -> int:
    """Return the index that the offset at `index` refers to."""
    return index + int(struct.unpack_from("<I", metadata, index)[0])


def _field(metadata: memoryview, table: int, number: int) -> int | None:
    """Return the index of a field of a table, None if it is absent."""
    vtable = table - struct.unpack_from("<i", metadata, table)[0]
    (size,) = struct.unpack_from("<H", metadata, vtable)
    entry = 4 + 2 * number
    if vtable < 0 or entry + 2 > size:
        return None
    (offset,) = struct.unpack_from("<H", metadata, vtable + entry)
    return table + offset if offset else None
