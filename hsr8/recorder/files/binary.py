"""Layouts of the binary files of a run: guarded payloads, and rows behind a JSON header.

Both begin with a magic word. Guarded payloads carry their length and checksum, so that damage is
detected and located. Rows have a fixed size; the header in front of them, preceded by its length
and padded to 8 bytes, describes them. A file of a killed run loses at most its last payload or row.
"""

import json
import struct
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from hsr8.errors import UsageError
from hsr8.file_format import check_magic

_GUARD = struct.Struct("<II")  # length [byte] and CRC-32 of the payload
_LENGTH = struct.Struct("<Q")


def guarded(payload: bytes) -> bytes:
    """Return `payload`, which is not empty, behind its length and checksum."""
    return _GUARD.pack(len(payload), zlib.crc32(payload)) + payload


def read_payloads(
    path: Path, magic: bytes, *, file: str, payload: str, whole: bool
) -> Iterator[tuple[str, bytes]]:
    """Yield the location, for messages, and the content of every payload of a file.

    Args:
        path: the file.
        magic: expected first bytes.
        file: kind of file, for messages: ``tape``.
        payload: kind of payload, for messages: ``block``.
        whole: require a complete last payload, which a killed run may lack.

    Raises:
        UsageError: the file is missing, damaged, or of another kind or format.
    """
    content = _content(path, magic, file)
    offset, count = len(magic), 0
    while offset < len(content):
        where, start = f"in {payload} {count}, at byte {offset}", offset + _GUARD.size
        length, checksum = 0, 0
        if start <= len(content):
            length, checksum = _GUARD.unpack_from(content, offset)
        if length == 0 or start + length > len(content):
            if whole:
                raise UsageError(f"{path}: cut off {where}")
            return
        body = content[start : start + length]
        if zlib.crc32(body) != checksum:
            raise UsageError(f"{path}: damaged {where}")
        yield where, body
        offset, count = start + length, count + 1


def head(magic: bytes, header: Mapping[str, Any]) -> bytes:
    """Return the first bytes of a file of rows: `magic` (8 bytes) and `header`."""
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    return magic + _LENGTH.pack(len(text)) + text


def read_rows(path: Path, magic: bytes, file: str) -> tuple[dict[str, Any], bytes]:
    """Return the header and the rows of a file.

    Args:
        path: the file.
        magic: expected first bytes.
        file: kind of file, for messages: ``walking table``.

    Raises:
        UsageError: the file is missing, cut off in its header, or of another kind or format.
    """
    content = _content(path, magic, file)
    start = len(magic) + _LENGTH.size
    try:
        end = start + _LENGTH.unpack_from(content, len(magic))[0]
        header = json.loads(content[start:end])
    except (struct.error, ValueError, OverflowError) as error:
        raise UsageError(f"{path}: incomplete header") from error
    if end > len(content) or not isinstance(header, dict):
        raise UsageError(f"{path}: incomplete header")
    return header, content[end:]


def _content(path: Path, magic: bytes, file: str) -> bytes:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UsageError(f"cannot read the {file} {path}: {error.strerror}") from error
    check_magic(content, magic, path, file)
    return content
