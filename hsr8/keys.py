"""Keys of configuration files: the annotation of each has type, bounds, scaling unit and text.

radius: Annotated[float, Interval(gt=0.0, le=2.0), "m", doc("Radius of the robot [m].")] = 0.12
"""

from collections.abc import Iterator
from dataclasses import is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from annotated_types import DocInfo, GroupedMetadata
from pydantic import BaseModel

Path = tuple[str | int, ...]
"""Keys of tables and indices of lists."""

TAGS = ("kind", "motion")  # keys that choose one of several tables


@cache
def hints(kind: Any) -> dict[str, Any]:
    """Return the annotations of a table or a parameter class by key; empty for other types."""
    table = isinstance(kind, type) and (issubclass(kind, BaseModel) or is_dataclass(kind))
    return get_type_hints(kind, include_extras=True) if table else {}


@cache
def texts(kind: Any) -> dict[str, str]:
    """Return the text of every documented key of a table or a parameter class."""
    return {
        key: mark.documentation
        for key, hint in hints(kind).items()
        for mark in getattr(hint, "__metadata__", ())
        if isinstance(mark, DocInfo)
    }


def chosen(annotation: Any, value: Any = None) -> tuple[Any, list[Any]]:
    """Return the type that a value has among those of an annotation, and its marks.

    Args:
        annotation: annotation of a key or of an entry of a list.
        value: chooses among several types.
    """
    marks: list[Any] = []
    while True:
        if get_origin(annotation) is Annotated:
            annotation, *given = get_args(annotation)
            for mark in given:
                marks += mark if isinstance(mark, GroupedMetadata) else [mark]
        elif get_origin(annotation) in (Union, UnionType):
            kinds = [kind for kind in get_args(annotation) if kind is not NoneType]
            annotation = kinds[0] if len(kinds) == 1 else _alternative(kinds, value)
        else:
            return annotation, marks


def entries(values: list[Any] | tuple[Any, ...], kind: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the entries of a list, each with its annotation."""
    for k, value in enumerate(values):
        yield value, entry(kind, k)


def entry(kind: Any, k: int) -> Any:
    """Return the annotation of an entry of a list; None beyond its end."""
    args = get_args(kind) if get_origin(kind) is tuple else ()
    if len(args) == 2 and args[1] is Ellipsis:
        return args[0]
    return args[k] if k < len(args) else None


def annotation_at(path: Path, kind: Any, data: Any) -> Any:
    """Return the annotation of the value at `path` in tables of some kind; None if unknown."""
    annotation = kind
    for part in path:
        table, _ = chosen(annotation, data)
        if isinstance(part, int):
            annotation = entry(table, part)
        elif get_origin(table) is dict:
            annotation = get_args(table)[1]
        else:
            annotation = hints(table).get(part)
        data = data[part] if holds(data, part) else None
    return annotation


def holds(data: Any, part: str | int) -> bool:
    """Whether `data` is a table with the key, or a list with the entry `part`."""
    if isinstance(data, dict):
        return part in data
    return isinstance(data, list) and isinstance(part, int) and part < len(data)


def depth(data: Any, path: Path) -> int:
    """Number of leading parts of `path` that `data` contains."""
    for k, part in enumerate(path):
        if not holds(data, part):
            return k
        data = data[part]
    return len(path)


def _alternative(kinds: list[Any], value: Any) -> Any:
    """The type among several for a value; of tables with a tag, the one that it names."""
    if isinstance(value, dict):
        tables = [kind for kind in kinds if hints(chosen(kind)[0])]
        tag = next((tag for tag in TAGS if tag in value), None)
        if len(tables) < 2:
            return tables[0] if tables else None
        named = (kind for kind in tables if tag and value[tag] in choices(hints(kind).get(tag)))
        return next(named, None)
    is_list = isinstance(value, list | tuple)
    plain = (kind for kind in kinds if not hints(chosen(kind)[0]))
    return next((k for k in plain if (get_origin(chosen(k)[0]) is tuple) == is_list), None)


def choices(annotation: Any) -> list[str]:
    """Return the values that a key may have, if its annotation lists them."""
    kind, _ = chosen(annotation)
    return [str(choice) for choice in get_args(kind)] if get_origin(kind) is Literal else []
