"""Tables of plain values; keys end in their units, as in the JSON output."""

import re
from collections.abc import Mapping, Sequence

from rich.markup import escape
from rich.table import Column, Table

from hsr8.errors import escaped, escaped_lines

UNITS = {"m": "m", "s": "s", "ms": "ms", "deg": "deg", "mps": "m/s", "radps": "rad/s", "kg": "kg"}


def facts(values: Mapping[str, object], title: str | None = None) -> Table:
    """Return a table with a line per key; keys without a value are left out."""
    table = Table(title=_title(title), title_justify="left", show_header=False)
    for key, value in values.items():
        if value is not None and value not in ({}, [], ""):
            table.add_row(_label(key), _cell(value))
    return table


def rows(values: Sequence[Mapping[str, object]], title: str | None = None) -> Table:
    """Return a table with a line per mapping and a column per key of the first."""
    columns = [Column(_label(key), overflow="fold") for key in values[0]]
    table = Table(*columns, title=_title(title), title_justify="left")
    for row in values:
        table.add_row(*map(_cell, row.values()))
    return table


def _title(title: str | None) -> str | None:
    return None if title is None else escape(escaped(title))


def _label(key: str) -> str:
    """Return a key with its unit in brackets: ``speed_mps`` becomes ``speed [m/s]``."""
    match = re.fullmatch(rf"(.+)(?<!_per)_({'|'.join(UNITS)})", key)
    name = f"{match[1]} [{UNITS[match[2]]}]" if match else key
    return escape(escaped(name.replace("_", " ")))


def _cell(value: object) -> str:
    text = _text(value)
    if not isinstance(value, str):
        text = text.removeprefix("(").removesuffix(")")
    return escape(escaped_lines(text))


def _text(value: object) -> str:
    match value:
        case None:
            return "-"
        case bool():
            return "yes" if value else "no"
        case float():
            return f"{value:.4g}"
        case list() | tuple():
            return f"({', '.join(map(_text, value))})"
        case Mapping():
            return f"({', '.join(f'{key} {_text(part)}' for key, part in value.items())})"
    return str(value)
