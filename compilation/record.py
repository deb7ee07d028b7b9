"""Records: tables and state of compiled functions, and parameters for them."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import DTypeLike, NDArray

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

WORD = 8  # bytes
Field = tuple[str, DTypeLike] | tuple[str, DTypeLike, int | tuple[int, ...]]


def record_type(*fields: Field) -> np.dtype[np.record]:
    """Return the type of records with fields of a name, a type and a shape.

    Every field begins at a multiple of `WORD`, which compiled code requires of nested records.

    Raises:
        TypeError: a name is that of an attribute of arrays, which would hide the field.
    """
    formats: list[Any] = []
    offsets, offset = [], 0
    for name, kind, *shape in fields:
        if hasattr(np.recarray, name):
            raise TypeError(f"{name}: name of a field; expected no attribute of arrays")
        of_field: Any = (kind, *shape) if shape else kind
        formats.append(of_field)
        offsets.append(offset)
        offset += -(-np.dtype(of_field).itemsize // WORD) * WORD
    layout: Any = {
        "names": [name for name, *_ in fields],
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
    return np.array([tuple(numbers.values())], record_type(*((n, np.float64) for n in numbers)))
