"""Files of payloads behind a magic word, each with its length and checksum before it.

A damaged payload is found and named, and a killed run loses its last payload at most.
"""

import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

from hsr8.errors import UsageError
from hsr8.file_format import check_magic
from hsr8.recorder.files.reading import read_bytes
from hsr8.recorder.files.writing import writing

_GUARD = struct.Struct("<II")  # length [byte] and CRC-32 of the payload


class GuardedWriter:
    """Appends payloads to a file.

    Args:
        path: file to create, or to go on with.
        magic: what the file begins with.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path, magic: bytes) -> None:
        self._folder = path.parent
        with writing(self._folder):
            self._file = path.open("ab")
            if not self._file.tell():
                self._file.write(magic)

    def write(self, payload: bytes) -> None:
        """Append `payload`, which is not empty."""
        with writing(self._folder):
            self._file.write(_GUARD.pack(len(payload), zlib.crc32(payload)) + payload)

    def flush(self) -> None:
        """Hand everything to the operating system."""
        with writing(self._folder):
            self._file.flush()

    def close(self) -> None:
        """Finish the file."""
        with writing(self._folder):
            self._file.close()


def read_payloads(
    path: Path, magic: bytes, *, file: str, payload: str, whole: bool
) -> Iterator[tuple[str, bytes]]:
    """Every payload of a file, with its place in words.

    Args:
        path: the file.
        magic: what it must begin with.
        file: what the file is, for messages: ``tape``.
        payload: what a payload is, for messages: ``block``.
        whole: whether the last payload must be complete; that of a killed run need not be.

    Raises:
        UsageError: it is missing, damaged, or of another kind or format.
    """
    try:
        content = read_bytes(path)
    except OSError as error:
        raise UsageError(f"cannot read the {file} {path}: {error.strerror}") from error
    check_magic(content, magic, path, file)
    place, count = len(magic), 0
    while place < len(content):
        where, start = f"in {payload} {count}, at byte {place}", place + _GUARD.size
        length, checksum = 0, 0
        if start <= len(content):
            length, checksum = _GUARD.unpack_from(content, place)
        if length == 0 or start + length > len(content):
            if whole:
                raise UsageError(f"{path} is cut off {where}")
            return
        found = content[start : start + length]
        if zlib.crc32(found) != checksum:
            raise UsageError(f"{path} is damaged {where}")
        yield where, found
        place, count = start + length, count + 1
