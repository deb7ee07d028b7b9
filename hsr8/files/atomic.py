"""Atomic output: a draft that replaces its target when it is complete.

After a crash a target is either the old or the new one, and several processes may write one
target. A link in place of the target is replaced, never followed.
"""

import errno
import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hsr8.errors import UsageError


@contextmanager
def draft(target: Path) -> Iterator[Path]:
    """Yield the path of a new file or folder, which becomes `target` at the end of the context.

    The draft has the name of the target, in a temporary folder next to it. An error in the context
    removes the draft and leaves the target as it was.

    Args:
        target: file, new or not, or new folder.

    Raises:
        OSError: the target cannot be written.
    """
    require_replaceable(target)
    folder = Path(tempfile.mkdtemp(prefix=".", suffix=".part", dir=target.parent))
    try:
        path = folder / target.name
        yield path
        if path.is_file():
            with path.open("rb") as file:
                os.fsync(file.fileno())
        path.replace(target)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def require_replaceable(target: Path) -> None:
    """Require a target that a draft can replace: a new one, a regular file, or a link.

    Raises:
        OSError: the target is a folder, a device or a pipe, or its folder is not writable.
    """
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, f"no folder {target.parent}")
    if not os.access(target.parent, os.W_OK | os.X_OK, effective_ids=True):
        raise PermissionError(errno.EACCES, f"the folder {target.parent} is not writable")
    if target.is_dir() and not target.is_symlink():
        raise IsADirectoryError(errno.EISDIR, "it is a folder")
    if target.exists() and not (target.is_file() or target.is_dir()):
        raise OSError(errno.EINVAL, "it is a device or a pipe")


def write_text(path: Path, text: str) -> None:
    """Replace the contents of `path` atomically.

    Characters that are not valid UTF-8, as in some file names, are escaped.
    """
    write_bytes(path, text.encode("utf-8", errors="backslashreplace"))


def write_bytes(path: Path, content: bytes) -> None:
    """Replace the contents of `path` atomically."""
    with draft(path) as new:
        new.write_bytes(content)


def write_new(path: Path, text: str) -> bool:
    """Write a new file atomically; return whether it did not exist before."""
    with tempfile.TemporaryDirectory(prefix=".", suffix=".part", dir=path.parent) as folder:
        new = Path(folder, path.name)
        new.write_text(text, encoding="utf-8", errors="backslashreplace")
        try:
            os.link(new, path)
        except FileExistsError:
            return False
    return True


def write_json(path: Path, value: Mapping[str, Any]) -> None:
    """Write `value` as indented JSON; numbers that are not finite become null."""
    write_text(path, dumps(value, indent=2) + "\n")


def overwrite_json(path: Path, value: Mapping[str, Any]) -> None:
    """Write `value` as `write_json` does; on a full disk overwrite the file in place."""
    text = dumps(value, indent=2) + "\n"
    try:
        write_text(path, text)
    except OSError:
        with open(path, "r+b", opener=no_link) as file:
            file.write(text.encode("utf-8"))
            file.truncate()


def no_link(path: str, flags: int) -> int:
    """Open a file for `open`, but not through a link.

    Raises:
        OSError: the path is a link, or cannot be opened.
    """
    if os.path.islink(path):
        raise OSError(errno.ELOOP, "it is a link")
    return os.open(path, flags | os.O_NOFOLLOW, 0o666)


def dumps(value: Any, indent: int | None = None) -> str:
    """Return standard JSON: numbers that are not finite become null.

    Characters that a terminal does not print, and bytes of a file name that are not valid UTF-8,
    become escapes, which JSON decodes again.
    """
    text = json.dumps(_finite(value), indent=indent, allow_nan=False, ensure_ascii=False)
    if not text.isprintable():  # such characters are in strings only: all others are ASCII
        text = "".join(c if c.isprintable() or c == "\n" else json.dumps(c)[1:-1] for c in text)
    return text


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


def require_temporary() -> None:
    """Check that temporary files can be written.

    Raises:
        UsageError: no folder for them can be written.
    """
    try:
        tempfile.gettempdir()
    except FileNotFoundError as error:
        raise UsageError(
            "TMPDIR: no folder for temporary files can be written, got /tmp, /var/tmp and the "
            "current folder; expected TMPDIR=DIR with a writable folder"
        ) from error
