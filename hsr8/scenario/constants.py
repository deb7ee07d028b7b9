"""Table ``[constants]``: parameters of the libraries that are not public keys, for studies."""

from collections.abc import Iterator
from dataclasses import asdict, is_dataclass
from functools import cache
from typing import Any, get_type_hints

from hsr8.scenario.key_lines import Path
from hsr8.scenario.presets import PROFILES, under
from hsr8.scenario.problem import Problem
from hsr8.scenario.public_keys import LIBRARIES, PUBLIC
from hsr8.scenario.schema import Scenario
from hsr8.suggestion import suggestion

CONSTANTS = "constants"
Table = dict[str, Any]


def misplaced(data: Table) -> Iterator[Problem]:
    """Constants given as settings, and settings or unknown keys given as constants."""
    for name in LIBRARIES:
        for path in _leaves(data.get(name), (name,)):
            if path not in _public() and path in _parameters():
                key = ".".join(path)
                yield Problem(path, f"a constant, not a setting; for studies, {CONSTANTS}.{key}")
    for path in _leaves(data.get(CONSTANTS, {}), ()):
        if not path:
            yield Problem((CONSTANTS,), "must be a table")
        elif path in _public():
            yield Problem(
                (CONSTANTS, *path), f"a setting, not a constant; expected {'.'.join(path)}"
            )
        elif path not in _parameters():
            hint = suggestion(".".join(path), constant_names())
            yield Problem((CONSTANTS, *path), f"unknown constant{hint}")


def constant_names() -> list[str]:
    """Return the dotted names of all constants."""
    return sorted(".".join(path) for path in _parameters() - _public())


def with_constants(data: Table) -> Table:
    """Tables of a scenario with the constants at their places."""
    merged = {key: value for key, value in data.items() if key != CONSTANTS}
    for name, table in data.get(CONSTANTS, {}).items():
        settings = merged.get(name, {})
        if isinstance(settings, dict):  # else validation reports it
            merged[name] = under(table, settings)
    return merged


def separated(data: Table) -> Table:
    """Tables of a complete scenario: its settings, and those constants that are not the default."""
    settings, constants = dict(data), {}
    for name in LIBRARIES:
        settings[name] = _pruned(data[name], (name,))
        if changed := _changed(data[name], _defaults(data, name), (name,)):
            constants[name] = changed
    return {**settings, CONSTANTS: constants} if constants else settings


def _defaults(data: Table, name: str) -> Table:
    if name == "navigation":
        return asdict(PROFILES[data[name]["profile"]]())
    return asdict(Scenario.model_fields[name].default)


def _pruned(table: Table, path: Path) -> Table:
    """The public keys of a table."""
    kept = {}
    for key, value in table.items():
        if isinstance(value, dict):
            if inner := _pruned(value, (*path, key)):
                kept[key] = inner
        elif (*path, key) in _public():
            kept[key] = value
    return kept


def _changed(table: Table, defaults: Table, path: Path) -> Table:
    """The constants of a table that differ from their defaults."""
    kept = {}
    for key, value in table.items():
        if isinstance(value, dict):
            if inner := _changed(value, defaults[key], (*path, key)):
                kept[key] = inner
        elif (*path, key) not in _public() and value != _plain(defaults[key]):
            kept[key] = value
    return kept


def _plain(value: Any) -> Any:
    """Tuples as lists, as JSON has them."""
    return [_plain(v) for v in value] if isinstance(value, list | tuple) else value


def _leaves(data: Any, path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """Paths of the values that are not tables."""
    if not isinstance(data, dict):
        yield path
        return
    for key, value in data.items():
        yield from _leaves(value, (*path, key))


@cache
def _public() -> frozenset[tuple[str, ...]]:
    return frozenset(tuple(key.split(".")) for key in PUBLIC)


@cache
def _parameters() -> frozenset[tuple[str, ...]]:
    """Paths of all parameters of the libraries."""
    hints = Scenario.model_fields
    return frozenset(
        path for name in LIBRARIES for path in _fields(hints[name].annotation, (name,))
    )


def _fields(annotation: Any, path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    if not is_dataclass(annotation):
        yield path
        return
    for name, hint in get_type_hints(annotation).items():
        yield from _fields(hint, (*path, name))
