"""Files of tables: Arrow IPC streams, one compressed batch per second.

A file that is cut off at any byte loses its last batch only.
"""

import errno
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import BinaryIO

import pyarrow as pa

from hsr8.recording.columns import Row, schema_of
from hsr8.recording.rows import TABLES
from hsr8.recording.table import Table
from hsr8.recording.write_errors import writing

SUFFIX = ".arrows"
WRITE = pa.ipc.IpcWriteOptions(compression="lz4", use_threads=False)  # zstd: 7 % less, 6x as slow
READ = pa.ipc.IpcReadOptions(use_threads=False)  # threads take ten times as long for many batches


class ArrowFiles:
    """Sink of a recorder that writes a file per table, or a buffer in memory.

    Args:
        folder: folder of the run, which exists; None for buffers.

    Attributes:
        rows: number of rows of each table so far.

    Raises:
        RecordingFailed: in every method, a file cannot be written.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self._opened = ExitStack()
        self._buffers: dict[str, pa.BufferOutputStream] = {}
        self._writers: dict[str, tuple[BinaryIO | None, pa.RecordBatchStreamWriter]] = {}
        self.rows = dict.fromkeys(TABLES, 0)

    def add(self, tables: Mapping[str, Table]) -> None:
        """Append rows."""
        with writing(self._folder):
            if self._folder is not None and not self._folder.exists():  # files outlive it
                raise FileNotFoundError(errno.ENOENT, "the folder was removed")
            for name, table in tables.items():
                if name not in self._writers:
                    self._writers[name] = self._open(name, table.arrow.schema)
                file, writer = self._writers[name]
                writer.write_table(table.arrow)
                if file is not None:
                    file.flush()
                self.rows[name] = self.rows.get(name, 0) + len(table)

    def close(self) -> dict[str, pa.Buffer]:
        """End the streams; close the files, or return the buffers by table."""
        with writing(self._folder):
            self._opened.close()
        return {name: buffer.getvalue() for name, buffer in self._buffers.items()}

    def _open(
        self, name: str, schema: pa.Schema
    ) -> tuple[BinaryIO | None, pa.RecordBatchStreamWriter]:
        if self._folder is None:
            self._buffers[name] = buffer = pa.BufferOutputStream()
            return None, self._opened.enter_context(pa.ipc.new_stream(buffer, schema))
        file = self._opened.enter_context((self._folder / f"{name}{SUFFIX}").open("wb"))
        writer = pa.ipc.new_stream(file, schema, options=WRITE)
        return file, self._opened.enter_context(writer)


def read_table(name: str, content: BinaryIO | pa.Buffer | None, row: Row) -> Table:
    """Return all whole batches of a table.

    Args:
        name: name of the table, for messages.
        content: its open file or its buffer; None for a table without rows.
        row: its columns.

    Raises:
        ValueError: it is not a table of this kind.
    """
    empty = schema_of(row).empty_table()
    if content is None:
        return Table(name, empty)
    try:
        reader = pa.ipc.open_stream(content, options=READ)
    except (pa.ArrowException, OSError):
        return Table(name, empty)  # not even the schema is whole
    _require_types(reader.schema, empty.schema)
    return Table(name, pa.Table.from_batches(_whole_batches(reader), reader.schema))


def _whole_batches(reader: pa.RecordBatchStreamReader) -> Iterator[pa.RecordBatch]:
    """Yield the batches up to the end, or to one that is cut off or damaged."""
    with suppress(StopIteration, pa.ArrowException, OSError):
        while True:
            batch = reader.read_next_batch()
            batch.validate(full=True)
            yield batch


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
