"""Results of runs as a Parquet table: one run per row, nested results as dotted columns."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hsr8.evaluation.sweep.job import RunResult
from hsr8.recorder.files import atomic


def flatten(result: RunResult, prefix: str = "") -> RunResult:
    """Return `result` with ``a: {b: 1}`` as ``a.b: 1``."""
    columns: RunResult = {}
    for key, value in result.items():
        if isinstance(value, dict):
            columns |= flatten(value, f"{prefix}{key}.")
        else:
            columns[prefix + key] = value
    return columns


def write_table(path: Path, results: Sequence[RunResult]) -> None:
    """Write `results`; missing values are null."""
    import pyarrow as pa  # noqa: PLC0415  takes half a second
    import pyarrow.parquet as pq  # noqa: PLC0415

    rows = [flatten(result) for result in results]
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: pa.array(_column([row.get(name) for row in rows])) for name in names}
    content = io.BytesIO()
    pq.write_table(pa.table(columns), content)
    atomic.write_bytes(path, content.getvalue())


def _column(values: list[Any]) -> list[Any]:
    """Return values of one type: integers and floats become floats, other mixtures text."""
    types = {type(value) for value in values if value is not None}
    if types == {int, float}:
        return [None if value is None else float(value) for value in values]
    if types == {str} or len(types) > 1:
        return [None if value is None else _text(value) for value in values]
    return values


def _text(value: Any) -> str:
    """Return text in which bytes of file names that are not UTF-8 are escaped."""
    return str(value).encode("utf-8", errors="backslashreplace").decode("utf-8")
