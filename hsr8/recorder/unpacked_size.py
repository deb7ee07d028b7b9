"""Unpacked size of an Arrow record batch, from its metadata, before Arrow allocates memory for it.

The metadata is a flatbuffer, see ``format/Message.fbs`` of the Arrow project. A table starts with
the distance to its vtable, which has the offset of every field, 0 for one that is absent.
"""

import struct

import numpy as np
import pyarrow as pa

HEADER, RECORD_BATCH = 2, 3  # field of the header of a message, and its type for a batch
LENGTH, BUFFERS, COMPRESSION = 0, 2, 3  # fields of a record batch
CODEC, LZ4 = 0, 0  # field of a compression, and its value
MAX_RATIO = 255  # of LZ4: a byte of a compressed block holds at most 255 bytes
UNCOMPRESSED = -1  # in place of the unpacked size of a buffer


def rows_and_size(message: pa.Message) -> tuple[int, int]:
    """Return the number of rows of a record batch and the size of its unpacked buffers [byte].

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
        if not 0 <= unpacked <= MAX_RATIO * size:
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
