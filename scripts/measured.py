"""CSV file of results of a separate study, for a page of `make benchmarks`."""

import csv
from collections.abc import Sequence
from pathlib import Path

from hsr8.recording.manifest import code_digest

KEYS = ("robot", "walker", "study", "level")
COLUMNS = (*KEYS, "result", "code")


def record(file: Path, results: Sequence[tuple[str, ...]]) -> None:
    """Put results into a file in place of older ones of the same robot, walker, study and level.

    Args:
        file: CSV file; made if it does not exist.
        results: robot, walker, study, level and result of each.
    """
    rows: dict[tuple[str, ...], dict[str, str]] = {}
    old = read_results(file) if file.exists() else []
    new = [dict(zip(COLUMNS, (*result, code_digest()), strict=True)) for result in results]
    for row in (*old, *new):
        rows[tuple(row[name] for name in KEYS)] = row
    with file.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows.values())


def read_results(file: Path) -> list[dict[str, str]]:
    """Return the rows of a file of results, see `COLUMNS`."""
    with file.open(newline="") as stream:
        return list(csv.DictReader(stream))
