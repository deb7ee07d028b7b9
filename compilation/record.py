"""Records: tables and state of compiled functions, and parameters for them."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

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
