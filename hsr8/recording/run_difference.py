"""Differences between two runs: the first row, column and values of every table."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from hsr8.errors import UsageError
from hsr8.files.tables import flatten
from hsr8.recording.rows import TABLES
from hsr8.recording.run import Run
from hsr8.recording.table import Table
from hsr8.recording.table_difference import Cell, first_cell
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
