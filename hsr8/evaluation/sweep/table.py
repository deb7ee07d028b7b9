"""Results of runs as a Parquet table: one run per row, nested results as dotted columns."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hsr8.evaluation.sweep.job import RunResult
from hsr8.files import atomic


def flatten(result: RunResult, prefix: str = "") -> RunResult:
    """Return `result` with ``a: {b: 1}`` as ``a.b: 1`` and ``a: [{b: 1}]`` as ``a.0.b: 1``."""
    columns: RunResult = {}
    for key, value in result.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            columns |= flatten({str(k): part for k, part in enumerate(value)}, f"{prefix}{key}.")
        elif isinstance(value, dict):
            columns |= flatten(value, f"{prefix}{key}.")
        else:
            columns[prefix + key] = value
    return columns


def write_table(path: Path, results: Sequence[RunResult]) -> None:
    """Write `results`; missing values are null, columns of mixed types text."""
    import pyarrow as pa  # noqa: PLC0415  takes half a second
    import pyarrow.parquet as pq  # noqa: PLC0415

    def column(values: list[Any]) -> Any:
        try:
            return pa.array(values)
        except (pa.ArrowInvalid, pa.ArrowTypeError, UnicodeEncodeError):
            texts = (None if v is None else str(v) for v in values)
            return pa.array(t and t.encode("utf-8", "backslashreplace").decode() for t in texts)

    rows = [flatten(result) for result in results]
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: column([row.get(name) for row in rows]) for name in names}
    content = io.BytesIO()
    pq.write_table(pa.table(columns), content)
    atomic.write_bytes(path, content.getvalue())
