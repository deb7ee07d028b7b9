"""Text: files in UTF-8, TOML with the lines of its keys, words and lines for a shell."""

import errno
import os
import shlex
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

KeyPath = tuple[str | int, ...]
"""Keys and indices of lists, from the uppermost table."""
MAX_REASON = 300  # characters of the parser's message


def read_text(path: str | os.PathLike[str]) -> str:
    """Return the text of a file in UTF-8, with or without a byte order mark.

    Raises:
        OSError: it cannot be read or is not UTF-8; `strerror` has the reason.
    """
    content = read_bytes(path)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        utf_16 = content.startswith((b"\xff\xfe", b"\xfe\xff"))
        got = "UTF-16" if utf_16 else f"byte 0x{content[error.start]:02x} at {error.start}"
        reason = f"wrong encoding, got {got}; expected UTF-8"
        raise OSError(errno.EILSEQ, reason) from None


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """Return the content of a file.

    Raises:
        OSError: it cannot be read; `strerror` has the reason.
    """
    try:
        return Path(path).read_bytes()
    except ValueError as error:  # a null character in the path
        raise OSError(errno.EINVAL, str(error)) from None


class TomlError(ValueError):
    """Invalid TOML; the message has the reason without the name of the file."""


def parse_toml(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text.

    Raises:
        TomlError: it is not TOML.
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise TomlError("invalid TOML: nested too deeply") from None
    except ValueError as error:
        reason = str(error)
        cut = f"{reason[:MAX_REASON]}..." if len(reason) > MAX_REASON else reason
        raise TomlError(f"invalid TOML: {cut}") from None


def lines_of(text: str, paths: Iterable[KeyPath]) -> dict[KeyPath, int]:
    """Return the line, from 1, on which the statement with the key at each path begins.

    Without the key, it is the line of the closest table around it; without a table, the path is
    left out.

    Args:
        text: valid TOML.
        paths: keys and indices of lists.
    """
    begins: dict[KeyPath, int] = {}
    for path, line in _statements(text):
        begins.setdefault(path, line)
    lines = {}
    for path in paths:
        around = [path[:k] for k in range(len(path), 0, -1) if path[:k] in begins]
        if around:
            lines[path] = begins[around[0]]
    return lines


def _statements(text: str) -> Iterator[tuple[KeyPath, int]]:
    """Yield every path in a valid TOML text with the first line of its statement.

    The statement ends with the first line up to which the parser accepts it.
    """
    table: KeyPath = ()
    counts: dict[KeyPath, int] = {}  # tables so far in each array of tables
    statement, begin = "", 1
    for number, line in enumerate(text.split("\n"), 1):
        begin = begin if statement else number
        statement += f"{line}\n"
        try:
            inner: Any = tomllib.loads(statement)
        except tomllib.TOMLDecodeError:
            continue
        if not statement.lstrip().startswith("["):
            yield from ((path, begin) for path in _paths(inner, table))
        else:
            table = ()
            while inner:
                ((key, inner),) = inner.items()
                table = (*table, key)
                yield table, begin
                if isinstance(inner, list):
                    counts[table] = counts.get(table, 0) + 1
                    (inner,) = inner
                if table in counts:
                    table = (*table, counts[table] - 1)
                    yield table, begin
        statement = ""


def _paths(value: Any, path: KeyPath) -> Iterator[KeyPath]:
    """Yield the paths of all keys and entries in a value."""
    pairs: Iterable[tuple[str | int, Any]] = ()
    if isinstance(value, dict):
        pairs = value.items()
    elif isinstance(value, list):
        pairs = enumerate(value)
    for key, inner in pairs:
        yield (*path, key)
        yield from _paths(inner, (*path, key))


def shell_word(word: str) -> str:
    """Return a word as a shell reads it: quoted, or as ``$'...'`` with escaped bytes."""
    if word.isprintable():
        return shlex.quote(word)
    plain = bytes(b for b in range(32, 127) if b not in b"\\'")
    escaped = (chr(b) if b in plain else f"\\x{b:02x}" for b in os.fsencode(word))
    return f"$'{''.join(escaped)}'"


def shell_line(words: Iterable[object]) -> str:
    """Return a command line."""
    return " ".join(shell_word(str(word)) for word in words)
