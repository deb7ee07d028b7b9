"""Tables of Markdown, and nested results as columns of a table."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Return the lines of a Markdown table, then an empty line; a `|` in a cell is escaped."""
    lines = [
        "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"
        for cells in (head, *rows)
    ]
    return [lines[0], "|---" * len(head) + "|", *lines[1:], ""]


def flatten(result: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return `result` with ``a: {b: 1}`` as ``a.b: 1`` and ``a: [{b: 1}]`` as ``a.0.b: 1``."""
    columns: dict[str, Any] = {}
    for key, value in result.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            columns |= flatten({str(k): part for k, part in enumerate(value)}, f"{prefix}{key}.")
        elif isinstance(value, dict):
            columns |= flatten(value, f"{prefix}{key}.")
        else:
            columns[prefix + key] = value
    return columns
