"""TOML texts: parser with bounds of depth and size."""

import re
import tomllib
from typing import Any

MAX_SIZE = 10_000_000  # of a file [byte]
MAX_KEYS = 50_000  # and headers
MAX_COMMAS = 1_000_000  # of lists, and of recordings
MAX_REASON = 300  # characters of the parser's message
_DEEP = re.compile(  # key of a pair, a header or an inline table
    r"""(?:^|[{,\[])[ \t]*+(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){32}""",
    re.MULTILINE,
)


class TomlError(ValueError):
    """Invalid TOML; the message has the reason without the name of the file."""


def parse_toml(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text.

    The time that the parser takes grows with the square of the depth of a key; the depth and the
    numbers of keys and values are bounded.

    Raises:
        TomlError: it is not TOML, or has too many keys or values.
    """
    if text.count("=") + text.count("[") > MAX_KEYS or text.count(",") > MAX_COMMAS:
        raise TomlError(f"too many keys or values; expected at most {MAX_KEYS:_} keys")
    if _DEEP.search(text):
        raise TomlError("invalid TOML: nested too deeply, a key of more than 32 parts")
    try:
        table = tomllib.loads(text)
        _require_64_bits(table)
        return table
    except RecursionError:
        raise TomlError("invalid TOML: nested too deeply") from None
    except ValueError as error:
        reason = str(error)
        cut = f"{reason[:MAX_REASON]}..." if len(reason) > MAX_REASON else reason
        raise TomlError(f"invalid TOML: {cut}") from None


def _require_64_bits(value: Any) -> None:
    """Check the integers in tables and lists; Python does not even print those of 4300 digits.

    Raises:
        ValueError: one has more than 64 bits.
    """
    if isinstance(value, dict | list):
        for inner in value.values() if isinstance(value, dict) else value:
            _require_64_bits(inner)
    elif isinstance(value, int) and not -(1 << 63) <= value < 1 << 63:
        raise ValueError(f"an integer of {value.bit_length()} bits; expected at most 64")
