"""Small values of the three libraries that are made many times per frame."""

from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(eq_default=False, frozen_default=True)
def value(cls: type[T]) -> type[T]:
    """Make an immutable dataclass with slots; values compare by identity.

    Only the type checker forbids assignment: a check at run time makes the constructor
    ten times as slow.
    """
    return dataclass(slots=True, eq=False)(cls)


@dataclass_transform(frozen_default=True)
def comparable_value(cls: type[T]) -> type[T]:
    """Make a value that compares by content; for fields without arrays."""
    return dataclass(slots=True)(cls)
