"""Records: tables and state of compiled functions, and parameters for them.

A record is a structure of numbers of fixed size, as in a header of C. Compiled functions read and
change records in place; an assignment of a record copies it. A function that gets a record from
another one shares it.
"""

from collections.abc import Iterator
from dataclasses import asdict, is_dataclass
from inspect import get_annotations
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    Generic,
    TypeVar,
    cast,
    get_args,
    get_origin,
    get_type_hints,
    overload,
)

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

T = TypeVar("T")

WORD = 8  # bytes
FieldType = type | np.dtype[Any] | tuple[Any, ...]


def record_type(**fields: FieldType) -> np.dtype[np.record]:
    """Return the type of records.

    Every field begins at a multiple of `WORD`, which compiled code requires of nested records.

    Args:
        fields: type of each field: a number, another record, or (one of these, *shape).

    Raises:
        TypeError: a name is that of an attribute of arrays, which would hide the field.
    """
    formats: list[Any] = []
    offsets, offset = [], 0
    for name, kind in fields.items():
        if hasattr(np.recarray, name):
            raise TypeError(f"{name}: name of a field; expected no attribute of arrays")
        one, *shape = kind if isinstance(kind, tuple) else (kind,)
        of_field: Any = (one, tuple(shape)) if shape else one
        formats.append(of_field)
        offsets.append(offset)
        offset += -(-np.dtype(of_field).itemsize // WORD) * WORD
    layout: Any = {
        "names": list(fields),
        "formats": formats,
        "offsets": offsets,
        "itemsize": offset,
    }
    return cast(np.dtype[np.record], np.dtype((np.record, np.dtype(layout, align=True))))


def record(parameters: "DataclassInstance", **others: float) -> NDArray[np.record]:
    """Return the numbers of a dataclass, and others, as an array of one record of floats (1,).

    Passing a record by itself to a compiled function costs more than most calls.
    """
    values = asdict(parameters) | others
    numbers = {name: v for name, v in values.items() if isinstance(v, int | float)}
    return np.array([tuple(numbers.values())], record_type(**dict.fromkeys(numbers, float)))


class Records(Generic[T]):
    """Array of records (n,), for annotations; at run time it is an array of NumPy."""

    if TYPE_CHECKING:
        size: int

        @overload
        def __getitem__(self, index: int) -> T: ...
        @overload
        def __getitem__(self, index: slice) -> "Records[T]": ...
        def __getitem__(self, index: int | slice) -> "T | Records[T]":
            raise NotImplementedError

        def __setitem__(self, index: int, value: T) -> None:
            raise NotImplementedError

        def __len__(self) -> int:
            raise NotImplementedError

        def __iter__(self) -> Iterator[T]:
            raise NotImplementedError


def record_class(cls: type[T]) -> type[T]:
    """Make the type of records from a class of annotated fields; type checkers see the class.

    A field is a number, another record, the parameters of a dataclass, or an array of fixed size:
    `Annotated[Array, 3]` of floats, `Annotated[Indices, 2]` of integers, `Annotated[Records[R], 2]`
    of records.

    Raises:
        TypeError: a name is that of an attribute of arrays, or an annotation none of these.
    """
    return cast(type[T], record_type(**{k: _kind(v) for k, v in get_annotations(cls).items()}))


def records(kind: type[T], number: int = 1) -> Records[T]:
    """Return records whose numbers are zero (n,)."""
    return cast("Records[T]", np.zeros(number, kind))


def _kind(annotation: Any) -> FieldType:
    """Return the type of an annotated field."""
    if get_origin(annotation) is Annotated:
        one, *shape = get_args(annotation)
        if get_origin(one) is np.ndarray:
            (one,) = get_args(get_args(one)[1])
        elif get_origin(one) in (NDArray, Records):  # NDArray is an alias from Python 3.12 on
            (one,) = get_args(one)
        return (one, *shape)
    if is_dataclass(annotation):
        hints = get_type_hints(annotation)
        return record_type(**{k: v for k, v in hints.items() if v in (int, float)})
    if annotation in (bool, int, float) or isinstance(annotation, np.dtype):
        return cast(FieldType, annotation)
    raise TypeError(f"{annotation}: type of a field; expected a number, a record or an array")
