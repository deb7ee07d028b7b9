"""Lines of keys in a TOML text; the parsers report no positions."""

import tomllib
from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

Path = tuple[str | int, ...]


def line_of(text: str, path: Path) -> int | None:
    """Line, from 1, on which the key at `path` begins, or the closest table around it.

    Parses prefixes of the text: a key begins on the first line of the shortest prefix that
    contains it.

    Args:
        text: valid TOML.
        path: keys and indices of lists.
    """
    rows = text.split("\n")
    data = tomllib.loads(text)
    while path and depth(data, path) < len(path):
        path = path[:-1]
    if not path:
        return None
    end = bisect_left(
        range(len(rows) + 1), True, key=lambda n: depth(_parsed(rows, n)[0], path) == len(path)
    )
    return _parsed(rows, end - 1)[1] + 1


def _parsed(rows: Sequence[str], n: int) -> tuple[dict[str, Any], int]:
    """Content and length of the longest valid prefix of at most `n` lines."""
    while True:
        try:
            return tomllib.loads("\n".join([*rows[:n], ""])), n
        except tomllib.TOMLDecodeError:
            n -= 1


def holds(data: Any, part: str | int) -> bool:
    """Whether `data` is a table with the key, or a list with the entry `part`."""
    if isinstance(data, dict):
        return part in data
    return isinstance(data, list) and isinstance(part, int) and part < len(data)


def depth(data: Any, path: Path) -> int:
    """Number of leading parts of `path` that `data` contains."""
    for k, part in enumerate(path):
        if not holds(data, part):
            return k
        data = data[part]
    return len(path)
