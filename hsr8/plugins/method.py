"""Methods of user-defined objects, and checks of the values that they return."""

from collections.abc import Callable
from inspect import signature
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
        form: signature of the method, for messages.
        result: type of the result.

    Attributes:
        name: kind and class of the object, for messages.

    Raises:
        UsageError: `plugin` lacks the method; from a call: the result is of another type.
    """

    def __init__(self, plugin: object, kind: str, form: str, result: type[Result]) -> None:
        if isinstance(plugin, type):
            name = plugin.__name__
            raise UsageError(f"{kind}={name}: expected an instance, {kind}={name}(), got the class")
        method = getattr(plugin, form.partition("(")[0], None)
        self.name = f"{kind} {type(plugin).__name__}"
        if not callable(method):
            raise UsageError(f"{self.name} has no method {form}")
        _require_inputs(method, form, self.name)
        self._method, self._form, self._result = method, form, result

    def __call__(self, *inputs: object) -> Result:
        """Call the method; it may change its inputs, so pass copies."""
        return self._checked(self._method(*inputs), self._result.__name__)

    def with_memory(self, memory: object, *inputs: object) -> tuple[Result, object]:
        """Call a method that takes and returns a memory, too."""
        expected = f"pair of {self._result.__name__} and memory"
        match self._method(memory, *inputs):
            case (result, kept):
                return self._checked(result, expected), kept
            case other:
                raise self._refused(other, expected)

    def _checked(self, result: object, expected: str) -> Result:
        if not isinstance(result, self._result):
            raise self._refused(result, expected)
        return result

    def _refused(self, result: object, expected: str) -> UsageError:
        return UsageError(
            f"{self.name}: {self._form} must return a {expected}, got {shown(result)}"
        )


def _require_inputs(method: Callable[..., object], form: str, name: str) -> None:
    """Require that a method can be called with the inputs of `form`."""
    try:
        parameters = signature(method)
    except ValueError:  # a method that is not written in Python
        return
    try:
        parameters.bind(*form.split(","))
    except TypeError as error:
        title = form.partition("(")[0]
        raise UsageError(f"{name}: expected {form}, got {title}{parameters}") from error


def takes_memory(plugin: object, method: str, names: tuple[str, ...]) -> bool:
    """Return whether the parameters of a method begin with `names`, the first of them memory."""
    function = getattr(plugin, method, None)
    try:
        parameters = tuple(signature(function).parameters) if callable(function) else ()
    except ValueError:  # a method that is not written in Python
        return False
    return parameters[: len(names)] == names


def start_of_memory(plugin: object, remembers: bool) -> Callable[[], object]:
    """Return the method `begin` of a plugin with a memory; else a function that returns None."""
    begin = getattr(plugin, "begin", None)
    return begin if remembers and callable(begin) else lambda: None


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
