"""Files with one JSON value a line, read back also where a kill cut the last line off."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from hsr8.errors import UsageError
from hsr8.recorder.reading import must_fit

T = TypeVar("T")


def read_lines(path: Path, parse: Callable[[str], T], *, whole: bool = False) -> Iterator[T]:
    """What `parse` makes of each whole line.

    Args:
        path: the file.
        parse: reads a line.
        whole: whether the last line must be complete; that of a killed run need not be.

    Raises:
        UsageError: a line is not what it should be, and the message names it; or the file cannot
            be read.
    """
    try:
        must_fit(path)
        file = path.open(encoding="utf-8", errors="replace")
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from error
    with file:
        for number, line in enumerate(file, start=1):
            if not line.endswith("\n"):
                if whole:
                    raise UsageError(f"{path}:{number}: the line is cut off")
                return
            try:
                yield parse(line)
            except (ValueError, TypeError, KeyError, IndexError) as error:
                raise UsageError(f"{path}:{number}: the line is damaged ({error})") from error
