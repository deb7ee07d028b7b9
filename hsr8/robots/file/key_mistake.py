"""Mistakes in the keys of a robot description."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from math import ceil, floor, isfinite, log10
from pathlib import Path
from typing import Any

from hsr8.errors import ModelError
from hsr8.robots.file.description import RobotDescription
from hsr8.suggestion import suggestion

MAX_LISTED = 12  # names in a message


class KeyMistake(ModelError):
    """Wrong value of a key; the message begins with the key, without the file."""


class RepairableError(ModelError):
    """Fault of a model that a key of the description repairs.

    Args:
        message: message with the remedy.
        keys: keys of the description, that repair it.
    """

    def __init__(self, message: str, **keys: Any) -> None:
        super().__init__(message)
        self.keys = keys


@contextmanager
def reading_keys(file: Path) -> Iterator[None]:
    """Context in which mistakes in keys receive the name of their file.

    Args:
        file: file of the description, or the model of a guessed one.

    Raises:
        ModelError: a key is wrong.
    """
    try:
        yield
    except KeyMistake as mistake:
        raise ModelError(f"{file}: {mistake}") from mistake


def at_least(value: float) -> str:
    """Return a number with three digits, rounded up, so that following a message is enough."""
    return f"{_rounded(value, ceil):g}"


def at_most(value: float) -> str:
    """Return a number with three digits, rounded down."""
    return f"{_rounded(value, floor):g}"


def _rounded(value: float, rounding: Callable[[float], int]) -> float:
    if value == 0.0 or not isfinite(value):
        return value
    unit = 10.0 ** (floor(log10(abs(value))) - 2)
    return rounding(value / unit) * unit


def joint_error(
    joint: str, key: str, description: RobotDescription, source: str, reason: str
) -> ModelError:
    """Return the error of a joint: of a key that states its value, else of the model.

    Args:
        joint: name of the joint.
        key: `range` or `effort`.
        description: description of the robot.
        source: model file.
        reason: value and expected value.
    """
    if joint in getattr(description, key):
        return KeyMistake(f"{key}.{joint}: {reason}")
    return ModelError(f"{source}: joint {joint!r}: {reason}")


def require_name(
    key: str, kind: str, name: str, names: Sequence[str], owner: str = "the model"
) -> None:
    """Require that a key names a part of the model.

    Args:
        key: key of the description.
        kind: kind of the part, such as ``body``.
        name: value of the key.
        names: names of all parts of this kind.
        owner: owner of these parts, for the message.

    Raises:
        KeyMistake: it has no such part.
    """
    if name in names:
        return
    more = f" and {len(names) - MAX_LISTED} more" if len(names) > MAX_LISTED else ""
    listed = (
        f"one of {', '.join(names[:MAX_LISTED])}{more}" if names else "no such key: it has none"
    )
    raise KeyMistake(
        f"{key}: {owner} has no {kind} {name!r}{suggestion(name, names)}; expected {listed}"
    )


def label(name: str, index: int) -> str:
    """Return a name, or the index of an element without a name."""
    return name or f"#{index}"
