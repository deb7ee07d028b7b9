"""Words and command lines for a shell, also with bytes that a terminal does not print."""

import os
import shlex
from collections.abc import Iterable


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
