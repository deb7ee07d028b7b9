"""Checks of the options of environments and policies."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import isfinite
from numbers import Integral, Real
from typing import Any

from hsr8.errors import UsageError
from hsr8.plugin_method import shown
from hsr8.suggestion import suggestion

TRACK_LIMIT = 128  # of the option max_tracks


def require_known(unknown: Iterable[str], options: Mapping[str, Any] | None) -> None:
    """Require that there are no unknown options.

    Args:
        unknown: names of unknown options.
        options: annotations of the function that has the options.

    Raises:
        UsageError: there is one.
    """
    known = [name for name in options or () if name not in ("return", "unknown")]
    for name in unknown:
        raise UsageError(
            f"{name}: unknown option, got {name!r}; expected one of {', '.join(known)}"
            f"{suggestion(name, known)}"
        )


def check_flag(option: str, value: object) -> None:
    """Require True or False.

    Raises:
        UsageError: `value` is anything else.
    """
    if not isinstance(value, bool):
        raise UsageError(f"{option}: wrong type, got {shown(value)}; expected True or False")


def check_integer(option: str, value: Any, low: int, high: int | None = None) -> None:
    """Require an integer from `low` to `high`, by default without upper limit.

    Raises:
        UsageError: `value` is anything else.
    """
    whole = isinstance(value, Integral) and not isinstance(value, bool)
    if not whole or value < low or (high is not None and value > high):
        limits = f"of at least {low}" if high is None else f"from {low} to {high}"
        raise UsageError(f"{option}: got {shown(value)}; expected an integer {limits}")


def check_names(option: str, value: object, known: Iterable[str], *, empty: bool = True) -> None:
    """Require a list or tuple of known names, which may be `empty`.

    Raises:
        UsageError: `value` is anything else.
    """
    choices = tuple(known)
    if not isinstance(value, list | tuple) or not (value or empty):
        raise UsageError(f"{option}: got {shown(value)}; expected a list of {', '.join(choices)}")
    for name in value:
        if name not in choices:
            raise UsageError(
                f"{option}: unknown name, got {name!r}; expected a list of {', '.join(choices)}"
                f"{suggestion(str(name), choices)}"
            )


def reward_weights(given: object, defaults: Mapping[str, float]) -> dict[str, float]:
    """Return the weights of all reward terms, with those of the option `reward`.

    Raises:
        UsageError: `given` is not a mapping, a term is unknown, or a weight is not a finite number.
    """
    expected = f"a dictionary with weights of {', '.join(defaults)}"
    if not isinstance(given, Mapping):
        raise UsageError(f"reward: wrong type, got {shown(given)}; expected {expected}")
    for name, weight in given.items():
        if name not in defaults:
            raise UsageError(
                f"reward: unknown term, got {name!r}; expected {expected}"
                f"{suggestion(str(name), tuple(defaults))}"
            )
        real = isinstance(weight, Real) and not isinstance(weight, bool)
        if not real or not isfinite(weight):
            raise UsageError(
                f"reward: wrong weight of {name}, got {shown(weight)}; expected a finite number"
            )
    return {**defaults, **{name: float(weight) for name, weight in given.items()}}


def flat_settings(settings: object) -> Sequence[str] | dict[str, Any]:
    """Return settings as a list of words, or as a mapping from dotted keys.

    Raises:
        UsageError: `settings` is neither a list of strings nor a mapping with names as keys.
    """
    if isinstance(settings, Mapping):
        return dict(_leaves(settings, ""))
    if isinstance(settings, list | tuple) and all(isinstance(word, str) for word in settings):
        return settings
    raise UsageError(
        f'settings: wrong type, got {shown(settings)}; expected a list of "key=value" or a '
        "dictionary"
    )


def _leaves(table: Mapping[Any, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    """Yield dotted keys and values; the table of a key may be nested."""
    for key, value in table.items():
        if not isinstance(key, str):
            raise UsageError(f"settings: wrong key, got {shown(key)}; expected a string")
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value
