"""Atomic replacement of small files: after a crash a file is either the old or the new one."""

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any


def write_text(path: Path, text: str) -> None:
    """Replace the contents of `path` atomically.

    Characters that are not valid UTF-8, as in some file names, are escaped.
    """
    write_bytes(path, text.encode("utf-8", errors="backslashreplace"))


def write_bytes(path: Path, content: bytes) -> None:
    """Replace the contents of `path` atomically."""
    draft = path.with_name(path.name + ".tmp")
    try:
        with draft.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(path)
    except OSError:
        with suppress(OSError):
            draft.unlink(missing_ok=True)
        raise


def write_json(path: Path, value: Mapping[str, Any]) -> None:
    """Write `value` as indented JSON; numbers that are not finite become null."""
    write_text(path, dumps(value, indent=2) + "\n")


def overwrite_json(path: Path, value: Mapping[str, Any]) -> None:
    """Write `value` as `write_json` does; on a full disk overwrite the file in place."""
    text = dumps(value, indent=2) + "\n"
    try:
        write_text(path, text)
    except OSError:
        with path.open("r+b") as file:
            file.write(text.encode("utf-8"))
            file.truncate()


def dumps(value: Any, indent: int | None = None) -> str:
    """Return standard JSON: numbers that are not finite become null.

    Bytes of a file name that are not valid UTF-8 become escapes, which JSON decodes again.
    """
    text = json.dumps(_finite(value), indent=indent, allow_nan=False, ensure_ascii=False)
    return text.encode("utf-8", errors="backslashreplace").decode("utf-8")


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value
