"""Defaults of a scenario's tables: presets, and quantities scaled to the robot by their units.

The built-in scenarios and all defaults are those for HSR-VIII. A user's values are literal.
"""

from collections.abc import Callable, Mapping
from dataclasses import MISSING, asdict, fields, is_dataclass
from typing import Any, get_args

from pydantic_core import PydanticUndefined

from hsr8.keys import TAGS, chosen, entries, hints
from hsr8.scenario.schema import Navigation, Scenario
from hsr8.scenario.section import Section
from hsr8.scenario.sensors import IDEAL
from navigation.parameters.navigation import NavigationParameters

Table = dict[str, Any]
Factor = Callable[[str], float]
"""Ratio of the quantities in some unit, see `hsr8.robots.scale.RobotScale.factor`."""

PROFILES = {"extended": NavigationParameters.extended, "paper": NavigationParameters.paper}


def expand_presets(data: Mapping[str, Any]) -> Table:
    """Return a scenario's tables with the values of its profile and camera.

    Given values take precedence. Malformed tables remain, for validation to report them.
    """
    expanded = dict(data)
    navigation, camera = data.get("navigation"), data.get("camera")
    if isinstance(navigation, dict):
        profile = navigation.get("profile")
        if isinstance(profile, str) and profile in PROFILES:
            expanded["navigation"] = under(navigation, asdict(PROFILES[profile]()))
    if isinstance(camera, dict) and camera.get("preset") == "ideal":
        return under(expanded, IDEAL)
    return expanded


def followers(data: Mapping[str, Any]) -> Table:
    """Return the defaults that follow given keys of a scenario's tables.

    Navigation takes the radius of the robot.
    """
    table = data.get("robot")
    radius = table.get("radius") if isinstance(table, dict) else None
    if isinstance(radius, bool) or not isinstance(radius, int | float):
        return {}
    return {"navigation": {"univector": {"s_robot": radius}}}


def under(given: Table, defaults: Table) -> Table:
    """Return `given` with `defaults` for the keys that are missing, table by table."""
    merged = {**defaults, **given}
    for key, default in defaults.items():
        if isinstance(default, dict) and isinstance(given.get(key), dict):
            merged[key] = under(given[key], default)
    return merged


def merged(base: Table, over: Table) -> Table:
    """Return `over` put over `base`, table by table."""
    # Another kind of mission, fault or mover has other keys: the old ones are dropped.
    changed = any(key in over and over[key] != base.get(key, over[key]) for key in TAGS)
    result = {} if changed else dict(base)
    if over.get("file") != base.get("file") and "file" in over:
        result.pop("data", None)  # of another track file
    for key, value in over.items():
        old = result.get(key)
        if isinstance(value, dict) and isinstance(old, dict):
            result[key] = merged(old, value)
        else:
            result[key] = value
    return result


def scaled(tables: Mapping[str, Any], factor: Factor) -> Table:
    """Return the tables of a scenario for another robot."""
    table: Table = _scaled(tables, Scenario, factor)
    return table


def with_scaled_defaults(tables: Mapping[str, Any], factor: Factor) -> Table:
    """Return the tables of a scenario with the scaled default of every missing quantity."""
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
        of = hints(kind)
        return {k: _scaled(v, of[k], factor) if k in of else v for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_scaled(v, hint, factor) for v, hint in entries(value, kind)]
    return value


def _completed(table: Table, kind: Any, factor: Factor, defaults: Any = None) -> Table:
    """`table` of some kind with the scaled values of `defaults`, or else of the kind."""
    full = dict(table)
    for key, hint in hints(kind).items():
        default = getattr(defaults, key, None) if defaults is not None else _default(kind, key)
        if key in table:
            full[key] = _with_defaults_inside(table[key], hint, factor, default)
        elif isinstance(default, Section) or is_dataclass(default):
            if inner := _completed({}, type(default), factor, default):
                full[key] = inner
        elif default is not None and _has_unit(hint):
            full[key] = _scaled(plain(default), hint, factor)
    return full


def _with_defaults_inside(value: Any, annotation: Any, factor: Factor, default: Any) -> Any:
    """A given value, with the scaled defaults of the tables in it."""
    kind, _ = _chosen(annotation, value)
    if isinstance(value, dict) and hints(kind):
        return _completed(value, kind, factor, default)
    if isinstance(value, list | tuple):
        return [_with_defaults_inside(v, hint, factor, None) for v, hint in entries(value, kind)]
    return value


def _chosen(annotation: Any, value: Any) -> tuple[Any, str | None]:
    """Type of a value and its unit."""
    kind, marks = chosen(annotation, value)
    return kind, next((mark for mark in reversed(marks) if isinstance(mark, str)), None)


def _has_unit(annotation: Any) -> bool:
    """Whether values of a type, or entries of such lists, have a unit."""
    marked = any(isinstance(mark, str) for mark in getattr(annotation, "__metadata__", ()))
    return marked or any(map(_has_unit, get_args(annotation)))


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


def plain(value: Any) -> Any:
    """Return a value with lists in the place of tuples, as JSON has them."""
    return [plain(v) for v in value] if isinstance(value, list | tuple) else value
