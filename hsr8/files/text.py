"""Text files in UTF-8, and TOML."""

import errno
import os
import tomllib
from pathlib import Path
from typing import Any

MAX_REASON = 300  # characters of the parser's message


def read_text(path: str | os.PathLike[str]) -> str:
    """Return the text of a file in UTF-8, with or without a byte order mark.

    Raises:
        OSError: it cannot be read or is not UTF-8; `strerror` has the reason.
    """
    content = read_bytes(path)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        utf_16 = content.startswith((b"\xff\xfe", b"\xfe\xff"))
        got = "UTF-16" if utf_16 else f"byte 0x{content[error.start]:02x} at {error.start}"
        reason = f"wrong encoding, got {got}; expected UTF-8"
        raise OSError(errno.EILSEQ, reason) from None


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """Return the content of a file.

    Raises:
        OSError: it cannot be read; `strerror` has the reason.
    """
    try:
        return Path(path).read_bytes()
    except ValueError as error:  # a null character in the path
        raise OSError(errno.EINVAL, str(error)) from None


class TomlError(ValueError):
    """Invalid TOML; the message has the reason without the name of the file."""


def parse_toml(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text.

    Raises:
        TomlError: it is not TOML.
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise TomlError("invalid TOML: nested too deeply") from None
    except ValueError as error:
        reason = str(error)
        cut = f"{reason[:MAX_REASON]}..." if len(reason) > MAX_REASON else reason
        raise TomlError(f"invalid TOML: {cut}") from None
