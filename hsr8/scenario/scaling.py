"""Scaling of a scenario's tables to another robot, by the units of the keys.

The built-in scenarios and all defaults are those for HSR-VIII. A user's values are literal.
"""

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic_core import PydanticUndefined

from hsr8.keys import hints
from hsr8.scenario.presets import PROFILES
from hsr8.scenario.schema import Navigation, Scenario
from hsr8.scenario.section import Section

Factor = Callable[[str], float]
"""Ratio of the quantities in some unit, see `hsr8.robots.scale.RobotScale.factor`."""
Table = dict[str, Any]
TAGS = ("kind", "motion")  # keys that choose one of several sections


def scaled(tables: Mapping[str, Any], factor: Factor) -> Table:
    """Return the tables of a scenario for another robot."""
    table: Table = _scaled(dict(tables), Scenario, factor)
    if "constants" in table:
        table["constants"] = _scaled(table["constants"], Scenario, factor)
    return table


def with_scaled_defaults(tables: Mapping[str, Any], factor: Factor) -> Table:
    """Return the tables of a scenario with the scaled default of every missing quantity.

    Constants are expected in the tables of their libraries.
    """
    table = dict(tables)
    navigation = table.get("navigation", {})
    if isinstance(navigation, dict):
        profile = PROFILES.get(str(navigation.get("profile")), PROFILES["extended"])
        table["navigation"] = _completed(navigation, Navigation, factor, profile())
    return _completed(table, Scenario, factor)


def is_complete(tables: Mapping[str, Any]) -> bool:
    """Return whether no default of a quantity is used."""
    return with_scaled_defaults(tables, lambda _: 2.0) == tables


def _scaled(value: Any, annotation: Any, factor: Factor) -> Any:
    kind, unit = _chosen(annotation, value)
    if unit is not None:
        return _product(value, factor(unit))
    if isinstance(value, dict):
        hints = _hints(kind)
        return {k: _scaled(v, hints[k], factor) if k in hints else v for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_scaled(v, hint, factor) for v, hint in _entries(value, kind)]
    return value


def _completed(table: Table, kind: Any, factor: Factor, defaults: Any = None) -> Table:
    """`table` of some kind with the scaled values of `defaults`, or else of the kind."""
    full = dict(table)
    for key, hint in _hints(kind).items():
        default = getattr(defaults, key, None) if defaults is not None else _default(kind, key)
        if key in table:
            full[key] = _with_defaults_inside(table[key], hint, factor, default)
        elif isinstance(default, Section) or is_dataclass(default):
            if inner := _completed({}, type(default), factor, default):
                full[key] = inner
        elif default is not None and _has_unit(hint):
            full[key] = _scaled(_plain(default), hint, factor)
    return full


def _with_defaults_inside(value: Any, annotation: Any, factor: Factor, default: Any) -> Any:
    """A given value, with the scaled defaults of the tables in it."""
    kind, _ = _chosen(annotation, value)
    if isinstance(value, dict) and _hints(kind):
        return _completed(value, kind, factor, default)
    if isinstance(value, list | tuple):
        return [_with_defaults_inside(v, hint, factor, None) for v, hint in _entries(value, kind)]
    return value


def _chosen(annotation: Any, value: Any) -> tuple[Any, str | None]:
    """Type of a value without its annotations and alternatives, and its unit."""
    unit = None
    while True:
        if get_origin(annotation) is Annotated:
            annotation, *marks = get_args(annotation)
            unit = next((mark for mark in marks if isinstance(mark, str)), unit)
        elif get_origin(annotation) in (Union, UnionType):
            kinds = [kind for kind in get_args(annotation) if kind is not NoneType]
            annotation = kinds[0] if len(kinds) == 1 else _tagged(kinds, value)
        else:
            return annotation, unit


def _has_unit(annotation: Any) -> bool:
    """Whether values of a type, or entries of such lists, have a unit."""
    marked = any(isinstance(mark, str) for mark in getattr(annotation, "__metadata__", ()))
    return marked or any(map(_has_unit, get_args(annotation)))


def _tagged(kinds: list[Any], value: Any) -> Any:
    """Section that a table chooses by its tag; None for an unknown one."""
    tag = next((tag for tag in TAGS if isinstance(value, dict) and tag in value), None)
    for kind in kinds:
        hint = _hints(kind).get(tag or "")
        if get_origin(hint) is Literal and value[tag] in get_args(hint):
            return kind
    return None


def _entries(values: list[Any] | tuple[Any, ...], kind: Any) -> list[tuple[Any, Any]]:
    """Entries of a list, each with its annotation."""
    hints = get_args(kind) if get_origin(kind) is tuple else ()
    if len(hints) == 2 and hints[1] is Ellipsis:
        return [(value, hints[0]) for value in values]
    return [(v, hints[k] if k < len(hints) else None) for k, v in enumerate(values)]


@cache
def _hints(kind: Any) -> dict[str, Any]:
    """Annotations of a section or a parameter class by key; empty for other types."""
    if isinstance(kind, type) and (issubclass(kind, Section) or is_dataclass(kind)):
        return hints(kind)
    return {}


def _default(kind: Any, key: str) -> Any:
    """Default of a key; None without one."""
    if issubclass(kind, Section):
        model = kind.model_fields.get(key)
        default = None if model is None else model.get_default(call_default_factory=True)
        return None if default is PydanticUndefined else default
    field = next(field for field in fields(kind) if field.name == key)
    if field.default_factory is not MISSING:
        return field.default_factory()
    return None if field.default is MISSING else field.default


def _product(value: Any, factor: float) -> Any:
    """Number, or list of numbers, times a factor; any other value as it is."""
    if isinstance(value, list | tuple):
        return [_product(v, factor) for v in value]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    return value * factor


def _plain(value: Any) -> Any:
    """Tuples as lists, as JSON has them."""
    return [_plain(v) for v in value] if isinstance(value, list | tuple) else value
