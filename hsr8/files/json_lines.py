"""Files with one JSON value per line, readable also if a kill cut off the last line."""

import fcntl
import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TextIO, TypeVar

from hsr8.errors import UsageError
from hsr8.files import atomic

T = TypeVar("T")

MAX_LINE = 16_000_000  # [byte]


def open_to_append(path: Path) -> TextIO:
    """Open a file to append lines, exclusively; the rest of a line that a kill cut off is removed.

    Raises:
        BlockingIOError: another process has opened the file so.
        OSError: the file cannot be written, or is a link.
    """
    with ExitStack() as undo:
        file = undo.enter_context(open(path, "a+", encoding="utf-8", opener=atomic.no_link))
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        size = os.fstat(file.fileno()).st_size
        start = max(0, size - MAX_LINE)
        end = start + os.pread(file.fileno(), size - start, start).rfind(b"\n") + 1
        file.truncate(end)
        undo.pop_all()
    return file


def read_lines(path: Path, parse: Callable[[str], T]) -> Iterator[T]:
    """Yield the result of `parse` for each complete line.

    Args:
        path: the file.
        parse: reads a line.

    Raises:
        UsageError: the file cannot be read, or a line is damaged.
    """
    try:
        file = path.open("rb")
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from error
    with file:
        for number, line in enumerate(iter(lambda: file.readline(MAX_LINE + 1), b""), start=1):
            if len(line) > MAX_LINE:
                raise UsageError(f"{path}:{number}: the line is longer than {MAX_LINE / 1e6:g} MB")
            if not line.endswith(b"\n"):
                return
            try:
                yield parse(line.decode("utf-8", errors="replace"))
            except (ValueError, TypeError, KeyError, IndexError) as error:
                raise UsageError(f"{path}:{number}: the line is damaged ({error})") from error
