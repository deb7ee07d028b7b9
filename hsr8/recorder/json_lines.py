"""Files with one JSON value a line, read back also where a kill cut the last line off."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from hsr8.errors import UsageError

T = TypeVar("T")


def read_lines(path: Path, parse: Callable[[str], T]) -> Iterator[T]:
    """What `parse` makes of each whole line.

    Raises:
        UsageError: a line is not what it should be; the message names it.
    """
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            if not line.endswith("\n"):
                return
            try:
                yield parse(line)
            except (ValueError, TypeError, KeyError, IndexError) as error:
                raise UsageError(f"{path}:{number}: the line is damaged ({error})") from error
