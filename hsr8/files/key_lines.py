"""Lines of keys in a TOML text, which the parser does not report."""

import re
import tomllib
from collections.abc import Iterable, Iterator

from hsr8.keys import Path

_BLANK = re.compile(r"(?:[ \t\r\n]++|#[^\n]*+)*+")
_PART = re.compile(r"""[ \t]*+([\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')[ \t]*+""")
_SCALAR = re.compile(
    r'''"""(?:[^"\\]|\\.|"(?!""))*+"{3,5}'''
    r"""|'''(?:[^']|'(?!''))*+'{3,5}"""
    r"""|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+'|[^,\]}\n#]++""",
    re.DOTALL,
)


def lines_of(text: str, paths: Iterable[Path]) -> dict[Path, int]:
    """Return the line, from 1, on which the key at each path begins.

    Without the key, it is the line of the closest table around it; without a table, the path is
    left out.

    Args:
        text: valid TOML.
        paths: keys and indices of lists.
    """
    paths = set(paths)
    wanted = {path[:k] for path in paths for k in range(1, len(path) + 1)}
    offsets: dict[Path, int] = {}
    for path, offset in _Scanner(text).positions():
        if path in wanted:
            offsets.setdefault(path, offset)
    lines = {}
    for path in paths:
        around = [path[:k] for k in range(len(path), 0, -1) if path[:k] in offsets]
        if around:
            lines[path] = text.count("\n", 0, offsets[around[0]]) + 1
    return lines


class _Scanner:
    """Position of every key and of every entry of a list in a valid TOML text."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._counts: dict[Path, int] = {}  # tables so far in each array of tables

    def positions(self) -> Iterator[tuple[Path, int]]:
        """Yield paths and offsets in the order of the text."""
        table: Path = ()
        while self._skip() < len(self._text):
            if self._text[self._at] != "[":
                yield from self._pair(table)
                continue
            start, several = self._at, self._text.startswith("[[", self._at)
            self._at += 2 if several else 1
            parts = self._parts()
            self._at += 2 if several else 1
            table = ()
            for k, part in enumerate(parts):
                table = (*table, part)
                yield table, start
                if several and k == len(parts) - 1:
                    self._counts[table] = self._counts.get(table, 0) + 1
                if table in self._counts:
                    table = (*table, self._counts[table] - 1)
                    yield table, start

    def _pair(self, table: Path) -> Iterator[tuple[Path, int]]:
        """Yield a key, the tables of its dotted parts, and the keys in its value."""
        start = self._at
        for part in self._parts():
            table = (*table, part)
            yield table, start
        self._at += 1  # the equals sign
        yield from self._value(table)

    def _value(self, path: Path) -> Iterator[tuple[Path, int]]:
        opening = self._text[self._skip()]
        if opening not in "[{":
            self._match(_SCALAR)
            return
        self._at += 1
        entries = 0
        while self._text[self._skip()] not in "]}":
            if self._text[self._at] == ",":
                self._at += 1
            elif opening == "{":
                yield from self._pair(path)
            else:
                yield (*path, entries), self._at
                yield from self._value((*path, entries))
                entries += 1
        self._at += 1

    def _parts(self) -> list[str]:
        """Return the parts of a dotted key."""
        parts = [self._part()]
        while self._text[self._at] == ".":
            self._at += 1
            parts.append(self._part())
        return parts

    def _part(self) -> str:
        part = self._match(_PART)[1]
        if part[0] not in "\"'":
            return part
        (key,) = tomllib.loads(f"{part} = 0") if "\\" in part else [part[1:-1]]
        return key

    def _skip(self) -> int:
        """Move behind blanks, line ends and comments; return the offset."""
        self._match(_BLANK)
        return self._at

    def _match(self, pattern: re.Pattern[str]) -> re.Match[str]:
        match = pattern.match(self._text, self._at)
        assert match is not None  # the text is valid
        self._at = match.end()
        return match
