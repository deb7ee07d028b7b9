"""Tables of a run: NumPy arrays by column, with units."""

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType, SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recording.columns import Row, batch_of, schema_of, shape_of
from hsr8.suggestion import suggestion

NO_LABELS: Mapping[str, Sequence[str]] = MappingProxyType({})


class Table(Mapping[str, Any]):
    """Columns of equal length.

    ``table[name]`` is an array (n, ...) with a row for each row of the table; text is an array of
    objects, a missing number NaN. A column of lists of objects, such as the tracks of a frame, is
    a table of all objects, see `Items`; one of lists of numbers is a list of arrays.

    Args:
        name: name of the table, for messages.
        arrow: the columns.
        chosen: indices of the rows of `arrow` that this table has; None for all.
    """

    def __init__(self, name: str, arrow: pa.Table, chosen: NDArray[np.intp] | None = None) -> None:
        self.name = name
        self._whole = arrow
        self._chosen = chosen
        self._columns: dict[str, Any] = {}

    @property
    def arrow(self) -> pa.Table:
        """The columns as an Arrow table, for other libraries."""
        return self._whole if self._chosen is None else self._whole.take(pa.array(self._chosen))

    @staticmethod
    def from_objects(
        name: str,
        row: Row,
        objects: Sequence[Any],
        labels: Mapping[str, Sequence[str]] = NO_LABELS,
    ) -> "Table":
        """Return recorded objects as a table with the columns of a row.

        Args:
            name: name of the table.
            row: the columns.
            objects: recorded objects.
            labels: names of the elements of named dimensions.
        """
        schema = schema_of(row, objects, labels)
        batches = [batch_of(row, objects, schema)] if objects else []
        return Table(name, pa.Table.from_batches(batches, schema))

    def __len__(self) -> int:
        """Return the number of rows."""
        return self._whole.num_rows if self._chosen is None else len(self._chosen)

    def __iter__(self) -> Iterator[str]:
        """Yield the names of the columns."""
        return iter(self._whole.schema.names)

    def __contains__(self, column: object) -> bool:
        """Return whether there is a column of this name."""
        return column in self._whole.schema.names

    def __getitem__(self, column: str) -> Any:
        """Return a column.

        Raises:
            UsageError: unknown column.
        """
        if column not in self._columns:
            field = self._field(column)
            array = self._chunks(column).combine_chunks()
            array = pa.concat_arrays(array.chunks) if isinstance(array, pa.ChunkedArray) else array
            self._columns[column] = _decoded(f"{self.name}.{column}", array, field)
        return self._columns[column]

    def unit(self, column: str) -> str:
        """Return the unit of a column, empty without one; errors as ``table[column]``."""
        return self._text(column, b"unit")

    def description(self, column: str) -> str:
        """Return the description of a column; errors as ``table[column]``."""
        return self._text(column, b"description")

    def names(self, column: str) -> tuple[str, ...]:
        """Return the names of the elements of a column of joints; errors as ``table[column]``."""
        return tuple(self._text(column, b"names").split(","))

    def present(self, column: str) -> tuple[NDArray[np.intp], NDArray[Any]]:
        """Return the rows (k,) that have a value of a column and these values (k, ...)."""
        valid = np.asarray(self._chunks(column).is_valid(), dtype=bool)
        rows = np.flatnonzero(valid)
        values = self[column]
        return rows, np.array([values[row] for row in rows.tolist()])

    def window(self, start: float, stop: float) -> "Table":
        """Return the rows from `start` to `stop` [s]."""
        time = self["time"]
        first, last = np.searchsorted(time, (start - 1e-9, stop + 1e-9)).tolist()
        return self.rows(first, last)

    def rows(self, first: int, last: int) -> "Table":
        """Return the rows from `first`, up to but not including `last`."""
        return Table(self.name, self.arrow.slice(first, max(0, last - first)))

    def take(self, rows: NDArray[np.intp]) -> "Table":
        """Return the rows with these indices; a column is copied when it is read."""
        chosen = rows if self._chosen is None else self._chosen[rows]
        return Table(self.name, self._whole, chosen)

    def at(self, times: Any) -> NDArray[np.intp]:
        """Return the index of the last row not after each of the times (m,) [s], at least 0.

        Raises:
            UsageError: the table has no rows, as after damage.
        """
        if np.size(times) and not len(self):
            raise UsageError(f"{self.name}: no rows, got times of other tables of the run")
        rows: NDArray[np.intp] = np.searchsorted(self["time"], np.asarray(times) + 1e-9, "right")
        return np.maximum(rows - 1, 0)

    def objects(self, *columns: str) -> list[SimpleNamespace]:
        """Return the rows as objects with an attribute per column, of plain Python values.

        A column of objects becomes a tuple of such objects.

        Args:
            columns: chosen columns, all by default; ``tracks.position`` chooses a column of the
                objects in ``tracks``.

        Raises:
            UsageError: unknown column.
        """
        parts: dict[str, list[str]] = {}
        for column in columns or tuple(self):
            name, _, part = column.partition(".")
            parts.setdefault(name, []).extend([part] if part else [])
        values = (_plain_rows(self[name], chosen) for name, chosen in parts.items())
        return [
            SimpleNamespace(**dict(zip(parts, row, strict=True)))
            for row in zip(*values, strict=True)
        ]

    def to_pandas(self) -> Any:
        """Return a pandas data frame; pandas must be installed."""
        return self.arrow.to_pandas()

    def _field(self, column: str) -> pa.Field:
        if column not in self:
            raise UsageError(
                f"{self.name}: unknown column {column!r}{suggestion(column, list(self))}"
            )
        return self._whole.schema.field(column)

    def _chunks(self, column: str) -> pa.ChunkedArray:
        chunks = self._whole.column(column)
        return chunks if self._chosen is None else chunks.take(pa.array(self._chosen))

    def _text(self, column: str, key: bytes) -> str:
        text: bytes = (self._field(column).metadata or {}).get(key, b"")
        return text.decode()


class Items(Table):
    """Objects of all rows of a column of lists, such as the tracks of all frames.

    Attributes:
        counts: number of objects of each row of the parent table (n,).
        parents: row of the parent table of each object.
    """

    def __init__(self, name: str, arrow: pa.Table, counts: NDArray[np.intp]) -> None:
        super().__init__(name, arrow)
        self.counts = counts
        self.parents = np.repeat(np.arange(len(counts)), counts)

    def of(self, row: int) -> Table:
        """Return the objects of one row of the parent table."""
        first = int(self.counts[:row].sum())
        return self.rows(first, first + int(self.counts[row]))


def _plain_rows(column: Any, parts: Sequence[str]) -> Sequence[Any]:
    """Return the values of a column as plain Python values, row by row."""
    if not isinstance(column, Items):
        values: list[Any] = column.tolist() if isinstance(column, np.ndarray) else column
        return values
    objects, ends = column.objects(*parts), np.cumsum(column.counts).tolist()
    counts = column.counts.tolist()
    return [tuple(objects[end - n : end]) for end, n in zip(ends, counts, strict=True)]


def _decoded(name: str, array: pa.Array, field: pa.Field) -> Any:
    type_, shape = field.type, shape_of(field)
    if pa.types.is_fixed_size_list(type_):
        return _numbers(array.flatten()).reshape(len(array), *shape)
    if not pa.types.is_list(type_):
        return _numbers(array)
    counts = np.diff(np.asarray(array.offsets)).astype(np.intp)
    values = array.flatten()
    if pa.types.is_struct(type_.value_type):
        columns = pa.Table.from_arrays(values.flatten(), schema=pa.schema(list(type_.value_type)))
        return Items(name, columns, counts)
    if pa.types.is_fixed_size_list(type_.value_type):
        elements = _numbers(values.flatten()).reshape(len(values), *shape)
        return np.split(elements, np.cumsum(counts)[:-1]) if len(counts) else []
    elements = _numbers(values)
    parts = np.split(elements, np.cumsum(counts)[:-1]) if len(counts) else []
    missing = ~np.asarray(array.is_valid(), dtype=bool)
    return [
        None if gone else part.reshape(shape) if shape else part
        for part, gone in zip(parts, missing, strict=True)
    ]


def _numbers(array: pa.Array) -> NDArray[Any]:
    """Return the elements as numbers; text, bytes and others as objects."""
    if pa.types.is_boolean(array.type) or pa.types.is_primitive(array.type):
        if array.null_count and not pa.types.is_floating(array.type):
            return np.array(array.to_pylist(), dtype=object)
        numbers: NDArray[Any] = array.to_numpy(zero_copy_only=False)
        return numbers
    return np.array(array.to_pylist(), dtype=object)
