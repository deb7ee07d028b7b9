"""On which line of a TOML text each key stands; the parser of the library does not tell."""

import re
from typing import Any

Path = tuple[str | int, ...]

_KEY = r"""(?:[A-Za-z0-9_-]+|"[^"\n]*"|'[^'\n]*')"""
_PATH = rf"{_KEY}(?:\s*\.\s*{_KEY})*"
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_PATH})\s*\]")
_ASSIGNMENT = re.compile(rf"\s*({_PATH})\s*=")
_PART = re.compile(_KEY)
_QUOTES = re.compile(r'"""|' + "'''")


def locate(text: str, data: dict[str, Any]) -> dict[Path, int]:
    """Line (from 1) of every table and key of `text`, whose content is `data`.

    Values inside an array or an inline table have no entry of their own: look for the
    nearest prefix.
    """
    lines: dict[Path, int] = {}
    counts: dict[Path, int] = {}
    table: Path = ()
    in_string = False
    for number, line in enumerate(text.splitlines(), start=1):
        opened = in_string
        if len(_QUOTES.findall(line)) % 2:
            in_string = not in_string
        if opened:
            continue
        header = _HEADER.match(line)
        if header:
            table = _resolve((), _parts(header[2]), counts)
            if header[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
                lines.setdefault(table, number)
                table = (*table, counts[table])
            lines[table] = number
            _outer(lines, (), table, number)
            continue
        assignment = _ASSIGNMENT.match(line)
        if assignment:
            path = _resolve(table, _parts(assignment[1]), counts)
            if _reaches(data, path):
                lines.setdefault(path, number)
                _outer(lines, table, path, number)
    return lines


def nearest(lines: dict[Path, Any], path: Path) -> Any:
    """Entry of the longest prefix of `path` that has one, or None."""
    for end in range(len(path), 0, -1):
        if path[:end] in lines:
            return lines[path[:end]]
    return None


def _outer(lines: dict[Path, int], table: Path, path: Path, number: int) -> None:
    """Tables that only the dots of `path` tell of, within `table`, are on its line."""
    for end in range(len(table) + 1, len(path)):
        lines.setdefault(path[:end], number)


def _parts(path: str) -> list[str]:
    return [part.strip("\"'") for part in _PART.findall(path)]


def _resolve(table: Path, parts: list[str], counts: dict[Path, int]) -> Path:
    """Path of a key; where it passes an array of tables it means the latest of them."""
    path = table
    for k, part in enumerate(parts):
        path = (*path, part)
        if k < len(parts) - 1 and path in counts:
            path = (*path, counts[path])
    return path


def holds(data: Any, part: str | int) -> bool:
    """Whether `data` is a table with the key, or a list with the entry `part`."""
    if isinstance(data, dict):
        return part in data
    return isinstance(data, list) and isinstance(part, int) and part < len(data)


def _reaches(data: Any, path: Path) -> bool:
    for part in path:
        if not holds(data, part):
            return False
        data = data[part]
    return True
