"""Differences between two runs or tables: the first row, column and values, bit for bit."""

import tomllib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.files.tables import flatten
from hsr8.recording.rows import TABLES
from hsr8.recording.run import Run
from hsr8.recording.table import Items, Table
from walking.parameters import CONTROL_PERIOD

CLOCKED = ("wall_time_s", "real_time_factor", "walk_tick_")  # results of the wall clock
CLOCKED_COLUMNS = ("walking_time",)


@dataclass(frozen=True, slots=True)
class RunDifference:
    """The first difference in one table of two runs.

    Attributes:
        record: table, or ``settings`` and ``results``.
        channel: quantity that differs.
        a, b: the two values; None if a run lacks the value.
        tick: control tick, None without a time.
        time: simulated time [s].
    """

    record: str
    channel: str
    a: Any
    b: Any
    tick: int | None = None
    time: float | None = None


def settings(a: Run, b: Run) -> Iterator[RunDifference]:
    """Yield every key of the scenario that differs."""
    tables = (flatten(_scenario(run)).items() for run in (a, b))
    keys = ({key: value for key, value in table if value != []} for table in tables)
    for key, x, y in _unequal(*keys):
        yield RunDifference("settings", key, x, y)


def results(a: Run, b: Run) -> Iterator[RunDifference]:
    """Yield every result that differs, except those of the wall clock."""
    for key, x, y in _unequal(flatten(a.metrics), flatten(b.metrics)):
        if not key.startswith(CLOCKED):
            yield RunDifference("results", key, x, y)


def first_differences(a: Run, b: Run) -> list[RunDifference]:
    """Return the first difference of every table, the earliest first.

    Recorded images are compared only if both runs keep the same images.

    Raises:
        UsageError: a table is damaged or, in a run that ended, cut off.
    """
    kept = [_scenario(run).get("recorder") for run in (a, b)]
    differences = [
        difference
        for name in TABLES
        if (name != "images" or kept[0] == kept[1])
        and (difference := _first(name, getattr(a, name), getattr(b, name)))
    ]
    return sorted(differences, key=lambda difference: difference.tick or 0)


def _first(name: str, a: Table, b: Table) -> RunDifference | None:
    cell, longer = first_cell(a, b, CLOCKED_COLUMNS), max(a, b, key=len)
    if cell is None:
        if len(a) == len(b):
            return None
        cell = Cell(min(len(a), len(b)), "", "number of rows", len(a), len(b))
    time = float(longer["time"][cell.row])
    tick = int(longer["tick"][cell.row]) if "tick" in longer else round(time / CONTROL_PERIOD)
    return RunDifference(name, cell.channel, cell.a, cell.b, tick, time)


def _scenario(run: Run) -> Mapping[str, Any]:
    try:
        return tomllib.loads(run.scenario_text())
    except (ValueError, RecursionError) as error:
        raise UsageError(f"cannot read {run.scenario_file}: {error}") from error


def _unequal(a: Mapping[str, Any], b: Mapping[str, Any]) -> Iterator[tuple[str, Any, Any]]:
    for key in [*a, *(key for key in b if key not in a)]:
        if a.get(key) != b.get(key):
            yield key, a.get(key), b.get(key)


@dataclass(frozen=True, slots=True)
class Cell:
    """The first difference of two tables.

    Attributes:
        row: columns of the tables.
        column: column of the tables.
        channel: column and element, with unit.
        a, b: the two values.
    """

    row: int
    column: str
    channel: str
    a: Any
    b: Any


def first_cell(a: Table, b: Table, ignored: Collection[str] = ()) -> Cell | None:
    """Return the first difference in the rows and columns that two tables share.

    Floating-point numbers are compared bit for bit; NaN equals NaN.
    """
    names = [name for name in a if name in b and name not in ignored]
    cells = [cell for name in names if (cell := _first_of_column(a, b, name)) is not None]
    return min(cells, key=lambda cell: cell.row, default=None)


def _first_of_column(a: Table, b: Table, name: str) -> Cell | None:
    x, y, rows = a[name], b[name], min(len(a), len(b))
    if isinstance(x, Items) and isinstance(y, Items):
        row = _first_row(x.counts, y.counts, rows)
        cell = first_cell(x, y)
        if cell is not None and (row is None or x.parents[cell.row] < row):
            parent = int(x.parents[cell.row])
            number = cell.row - int(x.counts[:parent].sum())
            return Cell(parent, name, f"{name}[{number}].{cell.channel}", cell.a, cell.b)
        if row is None:
            return None
        return Cell(row, name, f"number of {name}", int(x.counts[row]), int(y.counts[row]))
    row = _first_row(x, y, rows)
    return None if row is None else _cell(a, name, row, x[row], y[row])


def _first_row(x: Any, y: Any, rows: int) -> int | None:
    """Return the first of the rows of two columns that differs."""
    if isinstance(x, np.ndarray) and x.shape[1:] == y.shape[1:]:
        differ = np.argwhere(_differ(x[:rows], y[:rows]))
        return int(differ[0, 0]) if len(differ) else None
    for row in range(rows):
        p, q = np.asarray(x[row]), np.asarray(y[row])
        if p.shape != q.shape or _differ(p, q).any():
            return row
    return None


def _differ(x: NDArray[Any], y: NDArray[Any]) -> NDArray[np.bool_]:
    """Return which elements differ, in any bit; NaN equals NaN."""
    if x.dtype.kind != "f" or y.dtype != x.dtype:
        return np.asarray(x != y)
    bits = f"i{x.dtype.itemsize}"
    p, q = np.ascontiguousarray(x).view(bits), np.ascontiguousarray(y).view(bits)
    return np.asarray((p != q) & ~(np.isnan(x) & np.isnan(y)))


def _cell(table: Table, name: str, row: int, x: Any, y: Any) -> Cell:
    """Return the first element that differs in the values of one row."""
    p, q = np.asarray(x), np.asarray(y)
    if p.shape != q.shape:
        sizes = [None if v is None else list(np.shape(v)) for v in (x, y)]
        return Cell(row, name, f"shape of {name}", *sizes)
    unit = f" [{table.unit(name)}]" if table.unit(name) else ""
    if not p.shape:
        return Cell(row, name, f"{name}{unit}", _plain(x), _plain(y))
    index = np.unravel_index(int(np.argmax(_differ(p, q))), p.shape)
    names = table.names(name)
    element = f"[{', '.join(map(str, index))}]"
    if len(names) == len(p):
        element = f" of {names[index[0]]}"
    return Cell(row, name, f"{name}{element}{unit}", _plain(p[index]), _plain(q[index]))


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value[:16].hex()
    return value.item() if isinstance(value, np.generic) else value
