"""Files with one JSON value a line, read back also where a kill cut the last line off."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from hsr8.errors import UsageError
from hsr8.recorder.files.reading import must_fit

T = TypeVar("T")


def read_lines(
    path: Path, parse: Callable[[str], T], *, whole: bool = False, size: int | None = None
) -> Iterator[T]:
    """What `parse` makes of each whole line.

    Args:
        path: the file.
        parse: reads a line.
        whole: whether the last line must be complete; that of a killed run need not be.
        size: how much of the file is read; all of it by default [byte].

    Raises:
        UsageError: a line is not what it should be, and the message names it; or the file cannot
            be read.
    """
    try:
        must_fit(path)
        file = path.open("rb")
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from error
    left, number = sys.maxsize if size is None else size, 0
    with file:
        while line := file.readline(left):
            left, number = left - len(line), number + 1
            if not line.endswith(b"\n"):
                if whole:
                    raise UsageError(f"{path}:{number}: the line is cut off")
                return
            try:
                yield parse(line.decode("utf-8", errors="replace"))
            except (ValueError, TypeError, KeyError, IndexError) as error:
                raise UsageError(f"{path}:{number}: the line is damaged ({error})") from error
