"""Small values that are made many times for every image."""

from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(frozen_default=True)
def value(cls: type[T]) -> type[T]:
    """A dataclass with slots that nobody changes once it is made.

    The type checker holds everybody to that. Nothing does at run time: that would make such a
    value several times as slow to make, and a tenth of the time for an image went into it.
    """
    return dataclass(slots=True, unsafe_hash=True)(cls)
