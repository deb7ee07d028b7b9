"""Small values that are made many times per frame."""

from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(eq_default=False, frozen_default=True)
def value(cls: type[T]) -> type[T]:
    """Make an immutable dataclass with slots; values compare by identity.

    Only the type checker forbids assignment: a check at run time makes the constructor
    several times as slow.
    """
    return dataclass(slots=True, eq=False)(cls)
