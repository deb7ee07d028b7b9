"""Methods of user-defined objects, and checks of the values that they return."""

from math import isfinite
from numbers import Real
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError

Array = NDArray[np.float64]
Result = TypeVar("Result")


class PluginMethod(Generic[Result]):
    """Method of a user-defined object that must return a `result`.

    Args:
        plugin: user-defined object.
        kind: planner, gaze or walker.
        signature: signature of the method, for messages.
        result: type of the result.

    Attributes:
        name: kind and class of the object, for messages.

    Raises:
        UsageError: `plugin` lacks the method; from a call: the result is of another type.
    """

    def __init__(self, plugin: object, kind: str, signature: str, result: type[Result]) -> None:
        if isinstance(plugin, type):
            name = plugin.__name__
            raise UsageError(f"{kind}={name}: expected an instance, {kind}={name}(), got the class")
        method = getattr(plugin, signature.partition("(")[0], None)
        self.name = f"{kind} {type(plugin).__name__}"
        if not callable(method):
            raise UsageError(f"{self.name} has no method {signature}")
        self._method, self._signature, self._result = method, signature, result

    def __call__(self, *inputs: object) -> Result:
        """Call the method; it may change its inputs, so pass copies."""
        result = self._method(*inputs)
        if not isinstance(result, self._result):
            raise UsageError(
                f"{self.name}: {self._signature} must return a {self._result.__name__}, "
                f"got {shown(result)}"
            )
        return result


def numbers(value: object) -> Array | None:
    """Return real numbers of any type as a new array of floats; None for everything else."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError):  # lists of different lengths, or data on another device
        return None
    return array.astype(np.float64) if array.dtype.kind in "fiu" else None


def number(value: object, key: str, name: str) -> float:
    """Return a finite number as a float.

    Raises:
        UsageError: `value` is anything else.
    """
    if not isinstance(value, Real) or not isfinite(value):
        raise UsageError(f"{name}: {key} must be a finite number, got {shown(value)}")
    return float(value)


def shown(value: object) -> str:
    """Return type, shape and shortened value."""
    shape = f" of shape {value.shape}" if isinstance(value, np.ndarray) else ""
    text = " ".join(repr(value).split())
    return f"{type(value).__name__}{shape} {text if len(text) <= 60 else text[:57] + '...'}"
