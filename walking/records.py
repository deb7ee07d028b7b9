"""Records: structures of numbers, for the state of the walk, its plan and its constants.

A record is a structure of numbers of fixed size, as in a header of C. Compiled functions read and
change records in place; an assignment of a record copies it. A function that gets a record from
another one shares it.

    walk   state of the walk, see `walking.tick.WALK`.
    plans  plan in force and other plans, see `walking.patterns.PLAN`.
    robot  constants of the robot and of its walk, see `walking.constants.ROBOT`; among them all
           `WalkingParameters`, section by section under the same names.

The record of a subject is defined in the file of its equations. Fields of variable length are
arrays next to the record, so the compiled code is the same for every robot. A field must not have
the name of an attribute of arrays (``base``, ``size``, ``data`` ...), which would hide it.
"""

from dataclasses import fields
from math import prod
from typing import Any

import numpy as np

from walking.parameters import WalkingParameters

Record = Any
"""Record, or array of records; type checkers do not know the fields."""

FieldType = type | np.dtype[Any] | tuple[Any, ...]

_NUMBERS: dict[type, str] = {float: "f8", int: "i8", bool: "?"}
WORD = 8  # bytes; every field begins at a multiple, which compiled code requires
GENERATORS = ("dcm", "preview", "paper", "robust")
"""Pattern generators; a record holds the index."""
DCM, PREVIEW, PAPER, ROBUST = range(len(GENERATORS))


def record(**types: FieldType) -> np.dtype[Any]:
    """Return the type of a record.

    Args:
        types: type of each field: a number, another record, or (one of these, *shape).
    """
    formats: list[Any] = []
    offsets, offset = [], 0
    for name, kind in types.items():
        if hasattr(np.recarray, name):
            raise TypeError(f"{name}: name of a field; expected no attribute of arrays")
        one, *shape = kind if isinstance(kind, tuple) else (kind,)
        number = np.dtype(_NUMBERS[one] if isinstance(one, type) else one)
        formats.append((number, tuple(shape)) if shape else number)
        offsets.append(offset)
        words = -(-number.itemsize * prod(shape) // WORD)
        offset += WORD * words
    layout: Any = {
        "names": list(types),
        "formats": formats,
        "offsets": offsets,
        "itemsize": offset,
    }
    return np.dtype((np.record, np.dtype(layout, align=True)))


def _section(cls: type) -> np.dtype[Any]:
    """Return the record of a section of the parameters; a choice is an index."""
    kinds = {field.name: field.default for field in fields(cls)}
    return record(
        **{
            name: int if isinstance(value, int | str) else float
            for name, value in kinds.items()
            if not isinstance(value, bool)
        }
    )


def _sections() -> dict[str, np.dtype[Any]]:
    parameters = WalkingParameters()
    names = [field.name for field in fields(parameters)]
    return {name: _section(type(getattr(parameters, name))) for name in names}


SECTIONS = _sections()
"""Records of the sections of `WalkingParameters`."""
