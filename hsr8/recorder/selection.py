"""Columns of the tables of a run, kept in memory while it is recorded."""

from collections.abc import Mapping, Sequence

import pyarrow as pa

from hsr8.recorder.rows import TABLES
from hsr8.recorder.table import Table


class Selection:
    """Listener of a recorder that keeps columns of its batches.

    Args:
        columns: names of the kept columns by table.
    """

    def __init__(self, columns: Mapping[str, Sequence[str]]) -> None:
        self._columns = columns
        self._batches: dict[str, list[pa.Table]] = {name: [] for name in columns}

    def __call__(self, tables: Mapping[str, Table]) -> None:
        """Keep the columns of a batch of tables."""
        for name in self._columns.keys() & tables.keys():
            self._batches[name].append(tables[name].arrow.select(self._columns[name]))

    def tables(self) -> dict[str, Table]:
        """Return the kept columns of all batches by table."""
        return {
            name: Table(name, pa.concat_tables(batches))
            if batches
            else Table.from_objects(name, TABLES[name], ())
            for name, batches in self._batches.items()
        }
