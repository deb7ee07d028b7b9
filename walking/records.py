"""Records: structures of numbers, for the state of the walk, its plan and its constants.

A record is a structure of numbers of fixed size, as in a header of C. Compiled functions read and
change records in place; an assignment of a record copies it. A function that gets a record from
another one shares it.

    walk   state of the walk, see `walking.tick.WALK`.
    plans  plan in force and other plans, see `walking.reference.PLAN`.
    robot  constants of the robot and of its walk, see `walking.constants.ROBOT`; among them all
           `WalkingParameters`, section by section under the same names.

The record of a subject is defined in the file of its equations. Fields of variable length are
arrays next to the record, so the compiled code is the same for every robot. A field must not have
the name of an attribute of arrays (``base``, ``size``, ``data`` ...), which would hide it.
"""

from dataclasses import fields
from typing import Any

import numpy as np

from compilation.record import record_type
from walking.parameters import WalkingParameters

Record = Any
"""Record, or array of records; type checkers do not know the fields."""

GENERATORS = ("preview", "mwpg")
"""Pattern generators; a record holds the index."""
MWPG = GENERATORS.index("mwpg")


def _section(cls: type) -> np.dtype[Any]:
    """Return the record of a section of the parameters; a choice is an index."""
    kinds = {field.name: field.default for field in fields(cls)}
    return record_type(
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
