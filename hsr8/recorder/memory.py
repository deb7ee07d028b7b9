"""Tables of a run in memory."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import pyarrow as pa

from hsr8.recorder.rows import TABLES
from hsr8.recorder.table import Table

ALL = MappingProxyType({name: [c.name for c in row.columns] for name, row in TABLES.items()})


class Memory:
    """Sink of a recorder that keeps columns of its batches.

    Args:
        columns: names of the kept columns by table; by default all of all tables.
    """

    def __init__(self, columns: Mapping[str, Sequence[str]] = ALL) -> None:
        self._columns = columns
        self._batches: dict[str, list[pa.Table]] = {name: [] for name in columns}

    def add(self, tables: Mapping[str, Table]) -> None:
        """Keep the columns of new rows."""
        for name in self._columns.keys() & tables.keys():
            self._batches[name].append(tables[name].arrow.select(self._columns[name]))

    def close(self, exit_reason: str) -> None:
        """Do nothing: the rows stay."""

    def tables(self) -> dict[str, Table]:
        """Return the kept columns of all batches by table."""
        return {
            name: Table(name, pa.concat_tables(batches))
            if batches
            else Table.from_objects(name, TABLES[name], ())
            for name, batches in self._batches.items()
        }
