"""Columns of a table: one line states the source, text, unit and shape of each.

Columns are filled from the recorded objects directly, without rows. A source that is a path of
attributes works in both directions: `batch_of` reads the attributes of recorded objects,
`attributes` returns them from a table.

A shape contains numbers, names of sizes that are constant in a run, like ``("joints",)``, and, at
the front only, ``n`` for a size that differs between rows.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, chain
from operator import attrgetter
from types import MappingProxyType
from typing import Any

import numpy as np
import pyarrow as pa

FLOAT, INT, SHADE = pa.float64(), pa.int64(), pa.uint8()
BOOL, TEXT, BYTES = pa.bool_(), pa.string(), pa.binary()
VARYING = "n"

Source = str | tuple[str, ...] | Callable[[Any], Any]


@dataclass(frozen=True)
class Column:
    """Column of a table.

    Attributes:
        source: path of attributes to the value in a recorded object, paths to its elements, or a
            function that returns the value.
        text: description, without unit and shape.
        unit: unit; empty for text, numbers of objects and truth values.
        shape: shape of the value of a row; empty for a scalar.
        type: Arrow type of one element; text for enumerations.
        optional: whether a row may lack a value; a path that leads through None has none.
        items: columns of the objects of a column of lists of objects, whose shape is (n,).
        arrays: function that returns all objects of several rows as arrays by column, which is
            faster than their attributes one by one.
        name: name of the column; by default the last attribute of its path.
        get: returns the value of a recorded object.
    """

    source: Source
    text: str
    unit: str = ""
    shape: tuple[int | str, ...] = ()
    type: pa.DataType = FLOAT
    optional: bool = False
    items: "Row | None" = None
    arrays: Callable[[Sequence[Any]], Mapping[str, Any]] | None = None
    name: str = ""
    get: Callable[[Any], Any] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Compile the source; complete name, and shape and type of a column of objects."""
        if isinstance(self.source, str) and not self.name:
            object.__setattr__(self, "name", self.source.rpartition(".")[2])
        object.__setattr__(self, "get", _getter(self.source, optional=self.optional))
        if self.items is not None:
            object.__setattr__(self, "shape", (VARYING,))
            object.__setattr__(self, "type", pa.struct(list(schema_of(self.items))))

    @property
    def varying(self) -> bool:
        """Whether the number of elements differs between rows."""
        return self.shape[:1] == (VARYING,)


class Row:
    """Columns of a table or of the objects in a column.

    Args:
        text: description of a row.
        columns: its columns.
    """

    def __init__(self, text: str, *columns: Column) -> None:
        self.text = text
        self.columns = columns


def schema_of(
    row: Row,
    objects: Sequence[Any] = (),
    labels: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> pa.Schema:
    """Return the Arrow schema of a row, with units and descriptions in the metadata.

    Args:
        row: the columns.
        objects: recorded objects, which have the sizes of named dimensions.
        labels: names of the elements of named dimensions.
    """
    sizes: dict[str, int] = {}
    for column in row.columns:
        value = next((v for v in map(column.get, objects) if v is not None), None)
        if value is not None and not column.varying:
            sizes |= zip(map(str, column.shape), np.shape(value), strict=True)
    return pa.schema([_field(column, sizes, labels) for column in row.columns])


def batch_of(row: Row, objects: Sequence[Any], schema: pa.Schema) -> pa.RecordBatch:
    """Return recorded objects, at least one, as a record batch with the columns of a row."""
    return pa.RecordBatch.from_arrays(_arrays(row, objects, schema), schema=schema)


def attributes(row: Row, table: Mapping[str, Any], path: str = "") -> Iterator[dict[str, Any]]:
    """Yield the attributes of the objects at `path`, one dictionary for each row of a table.

    It is the inverse of `batch_of` for sources that are paths of attributes; columns of objects
    are left out.

    Args:
        row: columns of the table.
        table: the table.
        path: path of attributes from the recorded objects; empty for those themselves.
    """
    values: dict[str, list[Any]] = {}
    for column in row.columns:
        sources = column.source if isinstance(column.source, tuple) else (column.source,)
        for k, source in enumerate(sources):
            if callable(source) or column.items is not None or source.rpartition(".")[0] != path:
                continue
            rows = table[column.name]
            rows = rows[:, k] if isinstance(column.source, tuple) else rows
            plain = isinstance(rows, np.ndarray) and rows.ndim == 1
            values[source.rpartition(".")[2]] = rows.tolist() if plain else list(rows)
    for numbers in zip(*values.values(), strict=True):
        yield dict(zip(values, numbers, strict=True))


def shape_of(field: pa.Field) -> tuple[int, ...]:
    """Return the shape of the value of a row, without the size that varies, from the metadata."""
    text = (field.metadata or {}).get(b"shape", b"").decode()
    return tuple(int(size) for size in text.split(",") if size)


def _getter(source: Source, *, optional: bool) -> Callable[[Any], Any]:
    """Return the function that returns the value at a source."""
    if callable(source):
        return source
    if not optional:
        return attrgetter(source) if isinstance(source, str) else attrgetter(*source)
    assert isinstance(source, str)
    steps = [*map(attrgetter, source.split("."))]

    def get(value: Any) -> Any:
        for step in steps:
            value = None if value is None else step(value)
        return value

    return get


def _field(
    column: Column, sizes: Mapping[str, int], labels: Mapping[str, Sequence[str]]
) -> pa.Field:
    shape = [sizes.get(s, 0) if isinstance(s, str) else s for s in column.shape]
    type_ = column.type
    inner = shape[1:] if column.varying else shape
    if inner and not (column.optional and not column.varying):
        type_ = pa.list_(type_, int(np.prod(inner)))
    if column.varying or (column.optional and inner):
        type_ = pa.list_(type_)
    metadata = {
        "unit": column.unit,
        "description": column.text,
        "shape": ",".join(map(str, inner)),
    }
    if isinstance(size := next(iter(column.shape), None), str) and size in labels:
        metadata["names"] = ",".join(labels[size])
    return pa.field(column.name, type_, metadata=metadata)


def _arrays(row: Row, objects: Sequence[Any], fields: Iterable[pa.Field]) -> list[pa.Array]:
    """Return the columns of recorded objects as Arrow arrays."""
    return [
        _array([*map(column.get, objects)], column, field_.type)
        for column, field_ in zip(row.columns, fields, strict=True)
    ]


def _array(values: Sequence[Any], column: Column, type_: pa.DataType) -> pa.Array:
    """Return the values of a column, one per recorded object, as an Arrow array."""
    if not column.shape:
        return pa.array(values, type_)
    if column.optional:  # a list, empty and null where the value is missing
        present = [np.empty(0) if value is None else np.ravel(value) for value in values]
        ends = accumulate(map(len, present), initial=0)
        marks = [None if value is None else end for value, end in zip(values, ends, strict=False)]
        offsets = pa.array([*marks, sum(map(len, present))], pa.int32())
        return pa.ListArray.from_arrays(offsets, _flat(np.concatenate(present), column.type))
    if not column.varying:
        if not type_.list_size:  # such as the obstacles of a world without any
            return pa.array([[]] * len(values), type_)
        return pa.FixedSizeListArray.from_arrays(_flat(values, column.type), type_.list_size)
    offsets = _offsets(values)
    if isinstance(type_.value_type, pa.FixedSizeListType):
        flat = _flat(np.concatenate(values), column.type)
        inner = pa.FixedSizeListArray.from_arrays(flat, type_.value_type.list_size)
        return pa.ListArray.from_arrays(offsets, inner)
    if column.items is not None and column.arrays is not None:
        arrays = column.arrays(values)
        fields = zip(column.items.columns, column.type, strict=True)
        parts = [_array(arrays[item.name], item, field.type) for item, field in fields]
    else:
        elements = [*chain.from_iterable(values)]
        if column.items is None or not elements:
            return pa.ListArray.from_arrays(offsets, pa.array(elements, column.type))
        parts = _arrays(column.items, elements, column.type)
    return pa.ListArray.from_arrays(
        offsets, pa.StructArray.from_arrays(parts, fields=[*column.type])
    )


def _flat(values: Sequence[Any] | np.ndarray, type_: pa.DataType) -> pa.Array:
    """Return all elements of arrays or tuples of equal shape in one Arrow array."""
    return pa.array(np.array(values, type_.to_pandas_dtype()).reshape(-1), type_)


def _offsets(values: Sequence[Any]) -> pa.Array:
    return pa.array([*accumulate(map(len, values), initial=0)], pa.int32())
