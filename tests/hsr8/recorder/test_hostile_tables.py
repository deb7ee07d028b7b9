"""Tables with valid checksums that are not those of a run, or unpack to more than they hold."""

import struct
import zlib
from functools import partial

import numpy as np
import pyarrow as pa
import pytest

from hsr8.errors import UsageError
from hsr8.recorder.rows import TABLES
from hsr8.recorder.stream import CHECKSUMS, read_table, rows_and_size
from hsr8.recorder.table import Table

ROWS = 900_000


def write(folder, table, options, change=lambda content: content):
    """Write a table named seconds with the checksum of its content; return its size."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema, options=options) as writer:
        writer.write_table(table)
    content = change(sink.getvalue().to_pybytes())
    (folder / "seconds.arrows").write_bytes(content)
    line = f"seconds {len(table)} {len(content)} {zlib.crc32(content):08x}\n"
    (folder / CHECKSUMS).write_text(line)
    return len(content)


def read(folder):
    return read_table(folder / "seconds.arrows", TABLES["seconds"], whole=True)


def times(rows):
    return pa.table({"time": pa.array(np.zeros(rows))})


def test_a_small_file_that_unpacks_to_much_is_refused(tmp_path):
    options = pa.ipc.IpcWriteOptions(compression="zstd")
    assert write(tmp_path, times(ROWS), options) < 50_000
    with pytest.raises(UsageError, match=r"another compression than LZ4"):
        read(tmp_path)


def test_a_buffer_that_cannot_hold_its_unpacked_size_is_refused(tmp_path):
    def lie(content):
        size = struct.pack("<q", 8000)
        assert size in content
        return content.replace(size, struct.pack("<q", 1_500_000_000))

    table = pa.table({"time": pa.array(np.arange(1000.0) // 10)})
    write(tmp_path, table, pa.ipc.IpcWriteOptions(compression="lz4"), lie)
    with pytest.raises(UsageError, match=r"bytes cannot hold 1500000000"):
        read(tmp_path)


@pytest.mark.parametrize(
    "table",
    [
        pa.table({"time": ["text"]}),
        pa.table({"time": pa.nulls(1)}),
        pa.table({"other": [0.0]}),
        pa.table({"time": [[0.0]]}),
    ],
)
def test_columns_of_other_types_are_refused(tmp_path, table):
    write(tmp_path, table, pa.ipc.IpcWriteOptions())
    with pytest.raises(UsageError, match=r"seconds\.arrows: not a table of a run: column"):
        read(tmp_path)


def test_no_damaged_metadata_is_trusted(tmp_path):
    """Every byte of the message of a batch is changed; Arrow gets only what fits its file."""
    table, options = times(50), pa.ipc.IpcWriteOptions(compression="lz4")

    def changed(place, content):
        return content[:place] + bytes([content[place] ^ 0x55]) + content[place + 1 :]

    refused = 0
    for place in range(write(tmp_path, table, options)):
        write(tmp_path, table, options, partial(changed, place))
        try:
            assert len(read(tmp_path)) <= 50
        except UsageError:
            refused += 1
    assert refused > 20


@pytest.mark.parametrize("compression", ["lz4", None])
def test_rows_and_size_are_those_of_the_batch(compression):
    rng = np.random.default_rng(3)
    columns = {"a": rng.normal(size=300), "b": np.zeros(300), "c": np.arange(300) % 7}
    batch = pa.record_batch({**columns, "d": ["x" * (k % 5) for k in range(300)]})
    sink = pa.BufferOutputStream()
    options = pa.ipc.IpcWriteOptions(compression=compression)
    with pa.ipc.new_stream(sink, batch.schema, options=options) as writer:
        writer.write_batch(batch)
    messages = pa.ipc.MessageReader.open_stream(pa.BufferReader(sink.getvalue()))
    _, message = messages
    rows, size = rows_and_size(message)
    assert rows == 300
    assert batch.nbytes <= size <= batch.nbytes + 64 * 9


def test_a_table_without_rows_has_none_at_a_time():
    table = Table("ticks", times(0))
    assert len(table.at([])) == 0
    with pytest.raises(UsageError, match="ticks: no rows"):
        table.at([0.0])
