"""Rows of results as a Parquet table: a run a line, nested results as dotted columns."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hsr8.evaluation.sweep.job import Row
from hsr8.recorder.files import atomic


def flat(row: Row, prefix: str = "") -> Row:
    """`row` with ``a: {b: 1}`` as ``a.b: 1``."""
    columns: Row = {}
    for key, value in row.items():
        if isinstance(value, dict):
            columns |= flat(value, f"{prefix}{key}.")
        else:
            columns[prefix + key] = value
    return columns


def write_table(path: Path, rows: Sequence[Row]) -> None:
    """Write `rows`; what a row lacks is null, a share that no run has is left out."""
    import pyarrow as pa  # noqa: PLC0415  takes half a second
    import pyarrow.parquet as pq  # noqa: PLC0415

    flattened = [flat(row) for row in rows]
    names = list(dict.fromkeys(name for row in flattened for name in row))
    columns = {name: _column([row.get(name) for row in flattened]) for name in names}
    content = io.BytesIO()
    pq.write_table(pa.table({name: pa.array(values) for name, values in columns.items()}), content)
    atomic.write_bytes(path, content.getvalue())


def _column(values: list[Any]) -> list[Any]:
    """Values of one type: whole numbers among others become real, a mixture becomes text."""
    kinds = {type(value) for value in values if value is not None}
    if kinds == {int, float}:
        return [None if value is None else float(value) for value in values]
    if kinds == {str} or len(kinds) > 1:
        return [None if value is None else _text(value) for value in values]
    return values


def _text(value: Any) -> str:
    """As text; of a file's name, bytes that are no UTF-8 become escapes."""
    return str(value).encode("utf-8", errors="backslashreplace").decode("utf-8")
