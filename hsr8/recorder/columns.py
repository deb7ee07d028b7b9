"""Columns of a table, derived from a dataclass.

The class states everything once: the annotation of a field gives the type of its column, the
docstring of the class its description, shape and unit: ``zmp: planned ZMP (2,) [m].`` The default
of a field, `at` or `computed`, states where the value is in the recorded object, by default in the
attribute of the same name. Columns are filled from the objects directly, without rows.

A shape contains numbers, names of sizes that are constant in a run, like ``(joints,)``, and, at
the front only, ``n`` for a size that differs between rows.
"""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
from itertools import accumulate, chain
from operator import attrgetter
from types import MappingProxyType, NoneType, UnionType
from typing import (
    Any,
    TypeVar,
    Union,
    cast,
    dataclass_transform,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np
import pyarrow as pa

T = TypeVar("T")

_ENTRY = re.compile(r"^((?:\w+, )*\w+): (.*)$")
_SHAPE = re.compile(r"\(((?:\w+, ?)*\w+,?)\)")
_UNIT = re.compile(r"\[([^\[\]]+)\]")
_VARYING = "n"
_SCALARS = {float: pa.float64(), int: pa.int64(), bool: pa.bool_(), bytes: pa.binary()}


@dataclass(frozen=True, slots=True)
class Column:
    """Column of a table.

    Attributes:
        name: of the field.
        description: of the field, without its unit.
        unit: empty for text, numbers of objects and truth values.
        shape: of the value of a row; empty for a scalar.
        type: Arrow type of one element.
        optional: whether a row may lack a value.
        source: returns the value of a recorded object.
        items: class of the items of a column of lists of objects.
    """

    name: str
    description: str
    unit: str
    shape: tuple[int | str, ...]
    type: pa.DataType
    optional: bool
    source: Callable[[Any], Any]
    items: type | None = None

    @property
    def varying(self) -> bool:
        """Whether the number of elements differs between rows."""
        return self.shape[:1] == (_VARYING,)


def at(*paths: str) -> Any:
    """Return a field with the value at a path of attributes, or the values at several."""
    return computed(attrgetter(*paths))


def computed(source: Callable[[Any], Any]) -> Any:
    """Return a field with the value that `source` returns for a recorded object."""
    return field(metadata={"source": source})


@dataclass_transform(kw_only_default=True, field_specifiers=(at, computed))
def row(rows: type[T]) -> type[T]:
    """Make a dataclass of columns, which is not instantiated."""
    return dataclass(kw_only=True)(rows)


def columns_of(rows: type) -> tuple[Column, ...]:
    """Return the columns of a dataclass.

    Raises:
        TypeError: a field has no description, or no type that a column can have.
    """
    return _columns_of(rows)


@cache
def _columns_of(rows: Any) -> tuple[Column, ...]:
    texts, hints = _descriptions(rows), get_type_hints(rows)
    return tuple(
        _column(f.name, hints[f.name], texts, f.metadata.get("source") or attrgetter(f.name))
        for f in fields(rows)
    )


def schema_of(
    rows: type,
    objects: Sequence[Any] = (),
    labels: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> pa.Schema:
    """Return the Arrow schema of a dataclass, with units and descriptions in the metadata.

    Args:
        rows: the dataclass.
        objects: recorded objects, which have the sizes of named dimensions.
        labels: names of the elements of named dimensions.
    """
    sizes: dict[str, int] = {}
    for column in columns_of(rows):
        value = next((v for v in map(column.source, objects) if v is not None), None)
        if value is not None and not column.varying:
            sizes |= zip(map(str, column.shape), np.shape(value), strict=True)
    return pa.schema([_field(column, sizes, labels) for column in columns_of(rows)])


def batch_of(rows: type, objects: Sequence[Any], schema: pa.Schema) -> pa.RecordBatch:
    """Return recorded objects, at least one, as a record batch with the columns of `rows`."""
    return pa.RecordBatch.from_arrays(_arrays(rows, objects, schema), schema=schema)


def shape_of(field: pa.Field) -> tuple[int, ...]:
    """Return the shape of the value of a row, without the size that varies, from the metadata."""
    text = (field.metadata or {}).get(b"shape", b"").decode()
    return tuple(int(size) for size in text.split(",") if size)


def _descriptions(rows: type) -> dict[str, str]:
    """Return the text of every attribute in the docstring of a class."""
    _, _, section = (rows.__doc__ or "").partition("Attributes:\n")
    entries: list[tuple[str, str]] = []
    for line in section.splitlines():
        entry = _ENTRY.match(line.strip()) if line.startswith(" " * 8) else None
        if entry is not None and not line.startswith(" " * 9):
            entries += [(name, entry[2]) for name in entry[1].split(", ")]
            last = len(entry[1].split(", "))
        elif line.strip() and entries:
            entries[-last:] = [(name, f"{text} {line.strip()}") for name, text in entries[-last:]]
    return dict(entries)


def _column(name: str, hint: Any, texts: dict[str, str], source: Callable[[Any], Any]) -> Column:
    if name not in texts:
        raise TypeError(f"{name}: the docstring does not describe it")
    text = texts[name]
    optional = NoneType in get_args(hint)
    if get_origin(hint) in (Union, UnionType):
        hint = next(part for part in get_args(hint) if part is not NoneType)
    unit, shapes = _UNIT.findall(text), _SHAPE.findall(text)
    description = _UNIT.sub("", text).rstrip(". ").strip()
    sizes: tuple[int | str, ...] = ()
    items, type_ = None, _SCALARS.get(hint, pa.string())  # enumerations and literals are text
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is np.ndarray:
        if not shapes:
            raise TypeError(f"{name}: the docstring does not give the shape of the array")
        type_ = pa.from_numpy_dtype(get_args(arguments[1])[0])
        sizes = tuple(int(s) if s.isdigit() else s for s in re.findall(r"\w+", shapes[-1]))
    elif origin is not None and is_dataclass(arguments[0]):
        items, sizes = cast(type, arguments[0]), (_VARYING,)
        type_ = pa.struct(list(schema_of(items)))
    elif origin is tuple:
        type_ = _SCALARS.get(arguments[0], pa.string())
        sizes = (_VARYING,) if arguments[-1] is Ellipsis else (len(arguments),)
    unit_text = unit[-1] if unit else ""
    return Column(name, description, unit_text, sizes, type_, optional, source, items)


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
        "description": column.description,
        "shape": ",".join(map(str, inner)),
    }
    if isinstance(size := next(iter(column.shape), None), str) and size in labels:
        metadata["names"] = ",".join(labels[size])
    return pa.field(column.name, type_, metadata=metadata)


def _arrays(rows: type, objects: Sequence[Any], fields_: Iterable[pa.Field]) -> list[pa.Array]:
    """Return the columns of recorded objects as Arrow arrays."""
    return [
        _array([*map(column.source, objects)], column, field_.type)
        for column, field_ in zip(columns_of(rows), fields_, strict=True)
    ]


def _array(values: list[Any], column: Column, type_: pa.DataType) -> pa.Array:
    """Return the values of a column, one per recorded object, as an Arrow array."""
    if not column.shape:
        return pa.array(values, type_)
    if column.optional:  # a list, empty and null where the value is missing
        present = [np.empty(0) if value is None else np.ravel(value) for value in values]
        missing = pa.array([value is None for value in values])
        return pa.ListArray.from_arrays(
            _offsets(present), _flat(np.concatenate(present), column.type), mask=missing
        )
    if not column.varying:
        if not type_.list_size:  # such as the obstacles of a world without any
            return pa.array([[]] * len(values), type_)
        return pa.FixedSizeListArray.from_arrays(_flat(values, column.type), type_.list_size)
    offsets = _offsets(values)
    if isinstance(type_.value_type, pa.FixedSizeListType):
        flat = _flat(np.concatenate(values), column.type)
        inner = pa.FixedSizeListArray.from_arrays(flat, type_.value_type.list_size)
        return pa.ListArray.from_arrays(offsets, inner)
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
