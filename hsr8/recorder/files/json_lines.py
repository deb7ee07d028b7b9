"""Files with one JSON value per line, readable also if a kill cut off the last line."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from hsr8.errors import UsageError

T = TypeVar("T")


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
        for number, line in enumerate(file, start=1):
            if not line.endswith(b"\n"):
                return
            try:
                yield parse(line.decode("utf-8", errors="replace"))
            except (ValueError, TypeError, KeyError, IndexError) as error:
                raise UsageError(f"{path}:{number}: the line is damaged ({error})") from error
