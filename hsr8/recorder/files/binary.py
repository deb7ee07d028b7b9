"""Layout of a binary file of rows: magic word, length of a JSON header, header, rows.

A file of a killed run loses at most its last row.
"""

import json
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hsr8.errors import UsageError
from hsr8.file_format import check_magic

_LENGTH = struct.Struct("<Q")


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
