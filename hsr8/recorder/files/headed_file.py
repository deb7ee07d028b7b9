"""Files of rows behind a JSON header, which says how to read them.

A file begins with a magic word, the length of the header and the header, padded so that the rows
are aligned. A file cut anywhere loses its last row at most.
"""

import json
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hsr8.errors import UsageError
from hsr8.file_format import check_magic
from hsr8.recorder.files.reading import read_bytes
from hsr8.recorder.files.writing import writing

_LENGTH = struct.Struct("<Q")


class HeadedWriter:
    """Appends rows to a file.

    Args:
        path: file to create, or to go on with.
        magic: what the file begins with, 8 bytes.
        header: how to read the rows.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path, magic: bytes, header: Mapping[str, Any]) -> None:
        text = json.dumps(header).encode()
        text += b" " * (-len(text) % 8)
        self._folder = path.parent
        with writing(self._folder):
            self._file = path.open("ab")
            if not self._file.tell():
                self._file.write(magic + _LENGTH.pack(len(text)) + text)

    def write(self, row: bytes) -> None:
        """Append `row`."""
        with writing(self._folder):
            self._file.write(row)

    def flush(self) -> None:
        """Hand everything to the operating system."""
        with writing(self._folder):
            self._file.flush()

    def close(self) -> None:
        """Finish the file."""
        with writing(self._folder):
            self._file.close()


def read_headed(path: Path, magic: bytes, file: str) -> tuple[dict[str, Any], bytes]:
    """Header and rows of a file.

    Args:
        path: the file.
        magic: what it must begin with.
        file: what the file is, for messages: ``walking table``.

    Raises:
        UsageError: it is missing, cut off in its header, or of another kind or format.
    """
    try:
        content = read_bytes(path)
    except OSError as error:
        raise UsageError(f"cannot read the {file} {path}: {error.strerror}") from error
    start = len(magic) + _LENGTH.size
    check_magic(content, magic, path, file)
    if len(content) < start:
        raise UsageError(f"{path} has no whole header")
    end = start + _LENGTH.unpack_from(content, len(magic))[0]
    try:
        header = json.loads(content[start:end])
    except ValueError as error:
        raise UsageError(f"{path} has no whole header") from error
    if end > len(content) or not isinstance(header, dict):
        raise UsageError(f"{path} has no whole header")
    return header, content[end:]
