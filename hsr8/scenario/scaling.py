"""Scaling of scenarios, which are written for HSR-VIII, to another robot.

The units in the annotations of the keys say how they scale. Values of built-in scenarios and
defaults are scaled; values of a user are literal.
"""

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

from pydantic import BaseModel
from pydantic_core import PydanticUndefined

from hsr8.robots.scale import RobotScale

Table = dict[str, Any]


def scaled(section: Any, value: Any, scale: RobotScale) -> Any:
    """Return a value with all quantities in it scaled.

    Args:
        section: annotation of the value: a section, a union or list of sections, or a quantity.
        value: tables, lists and numbers as in a file; malformed values remain.
        scale: of the robot.
    """
    annotation, unit = _peeled(section)
    if unit is not None:
        return _times(value, scale.factor(unit))
    if isinstance(value, Mapping):
        kinds = _keys(_chosen(annotation, value))
        return {k: scaled(kinds[k], v, scale) if k in kinds else v for k, v in value.items()}
    if isinstance(value, list):
        return [scaled(part, v, scale) for part, v in zip(_parts(annotation, value), value)]  # noqa: B905
    return value


def completed(section: Any, value: Any, scale: RobotScale) -> Any:
    """Return tables with the scaled defaults of all quantities that they lack; see `scaled`."""
    annotation, unit = _peeled(section)
    if isinstance(value, list) and unit is None:
        return [completed(part, v, scale) for part, v in zip(_parts(annotation, value), value)]  # noqa: B905
    if not isinstance(value, Mapping):
        return value
    chosen = _chosen(annotation, value)
    table = dict(value)
    for key, kind in _keys(chosen).items():
        inner, _ = _peeled(kind)
        if key in table:
            table[key] = completed(kind, table[key], scale)
            continue
        default = _default(chosen, key)
        if default is None:
            continue
        if _is_section(inner):
            table[key] = completed(kind, {}, scale)
        elif (value_scaled := scaled(kind, _plain(default), scale)) != _plain(default):
            table[key] = value_scaled
    return table


def _peeled(annotation: Any) -> tuple[Any, str | None]:
    """Return an annotation without metadata and None, and its unit."""
    unit = None
    while True:
        if get_origin(annotation) is Annotated:
            annotation, *metadata = get_args(annotation)
            unit = next((part for part in metadata if isinstance(part, str)), unit)
        elif type(None) in get_args(annotation) and len(get_args(annotation)) == 2:
            annotation = next(part for part in get_args(annotation) if part is not type(None))
        else:
            return annotation, unit


def _is_section(annotation: Any) -> bool:
    if not isinstance(annotation, type):
        return False
    return issubclass(annotation, BaseModel) or is_dataclass(annotation)


def _chosen(annotation: Any, value: Mapping[str, Any]) -> Any:
    """Return the section of a union that the table's kind chooses; the annotation otherwise."""
    for part in get_args(annotation):
        section, _ = _peeled(part)
        if not _is_section(section):
            found = _chosen(section, value)
            if _is_section(found):
                return found
            continue
        for key, kind in _hints(section).items():
            choices = get_args(kind) if get_origin(kind) is Literal else ()
            if key in ("kind", "motion") and value.get(key) in choices:
                return section
    return annotation


def _parts(annotation: Any, value: list[Any]) -> Iterator[Any]:
    """Yield the annotation of every element of a list."""
    parts = get_args(annotation)
    if len(parts) == 2 and parts[1] is Ellipsis:
        parts = parts[:1] * len(value)
    yield from parts
    yield from [Any] * (len(value) - len(parts))


def _keys(section: Any) -> dict[str, Any]:
    return _hints(section) if _is_section(section) else {}


def _hints(section: Any) -> dict[str, Any]:
    hints = get_type_hints(section, include_extras=True)
    names = section.model_fields if issubclass(section, BaseModel) else section.__dataclass_fields__
    return {name: hints[name] for name in names}


def _default(section: Any, key: str) -> Any:
    """Return the default of a key; None without one."""
    if issubclass(section, BaseModel):
        default = section.model_fields[key].get_default(call_default_factory=True)
        return None if default is PydanticUndefined else default
    (field,) = (field for field in fields(section) if field.name == key)
    if field.default_factory is not MISSING:
        return field.default_factory()
    return None if field.default is MISSING else field.default


def _times(value: Any, factor: float) -> Any:
    """Return numbers times a factor, also in lists; other values remain."""
    if isinstance(value, list | tuple):
        return [_times(part, factor) for part in value]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    return value * factor


def _plain(value: Any) -> Any:
    """Return tuples as lists, as files have them."""
    return [_plain(part) for part in value] if isinstance(value, list | tuple) else value
