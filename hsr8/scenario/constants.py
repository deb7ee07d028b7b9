"""Table ``[constants]``: parameters of the libraries that are not public keys.

Studies change them: ``constants.navigation.gaze.risk.look_time = 0.3``.
"""

from collections.abc import Iterator
from dataclasses import asdict
from functools import cache
from typing import Any

from hsr8.mistakes import Mistake
from hsr8.robots.scale import DEFAULT_ROBOT
from hsr8.scenario.reference import LIBRARIES, parameters, public_keys
from hsr8.scenario.scaling import PROFILES, followers, plain, under
from hsr8.scenario.schema import Scenario
from hsr8.suggestion import suggestion

CONSTANTS = "constants"
Table = dict[str, Any]


def misplaced(data: Table) -> Iterator[Mistake]:
    """Yield constants given as settings, and settings or unknown keys given as constants."""
    for key in _flat({name: data[name] for name in LIBRARIES if name in data}):
        if key in constant_names():
            text = f"a constant, not a setting; for studies, {CONSTANTS}.{key}"
            yield Mistake(tuple(key.split(".")), text)
    given = data.get(CONSTANTS, {})
    if not isinstance(given, dict):
        yield Mistake((CONSTANTS,), "must be a table")
        return
    for key in _flat(given):
        path = (CONSTANTS, *key.split("."))
        if key in public_keys():
            yield Mistake(path, f"a setting, not a constant; expected {key}")
        elif key not in constant_names():
            yield Mistake(path, f"unknown constant{suggestion(key, constant_names())}")


@cache
def constant_names() -> tuple[str, ...]:
    """Return the dotted names of all constants."""
    return tuple(name for name, text in parameters().items() if not text)


def with_constants(data: Table) -> Table:
    """Return the tables of a scenario with the constants merged into their sections."""
    merged = {key: value for key, value in data.items() if key != CONSTANTS}
    for name, table in data.get(CONSTANTS, {}).items():
        settings = merged.get(name, {})
        if isinstance(settings, dict):  # else validation reports it
            merged[name] = under(table, settings)
    return merged


def placed(table: Table) -> Table:
    """Return tables of the libraries with their constants moved to ``[constants]``."""
    values = _flat({name: table[name] for name in LIBRARIES if name in table})
    settings = _nested({key: value for key, value in values.items() if key in public_keys()})
    constants = _nested({key: value for key, value in values.items() if key not in public_keys()})
    return {**table, **settings, **({CONSTANTS: constants} if constants else {})}


def separated(data: Table) -> Table:
    """Return a complete scenario as its settings and the constants that are not at the default.

    For another robot than HSR-VIII, whose defaults are scaled, all constants are returned.
    """
    libraries, settings, constants = {name: data[name] for name in LIBRARIES}, dict(data), {}
    values, usual = _flat(libraries), _usual(data["navigation"]["profile"]) | _flat(followers(data))
    settings |= _nested({key: value for key, value in values.items() if key in public_keys()})
    scales = data["robot"]["model"] != DEFAULT_ROBOT
    constants = {
        key: value
        for key, value in values.items()
        if key not in public_keys() and (scales or value != plain(usual[key]))
    }
    return {**settings, CONSTANTS: _nested(constants)} if constants else settings


@cache
def _usual(profile: str) -> Table:
    """Defaults of the libraries by dotted key."""
    defaults = {name: asdict(Scenario.model_fields[name].default) for name in LIBRARIES}
    return _flat(defaults | {"navigation": asdict(PROFILES[profile]())})


def _flat(table: Table, prefix: str = "") -> Table:
    """Values of nested tables by dotted key."""
    flat: Table = {}
    for key, value in table.items():
        flat |= (
            _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {prefix + key: value}
        )
    return flat


def _nested(flat: Table) -> Table:
    """Nested tables of values by dotted key."""
    nested: Table = {}
    for dotted, value in flat.items():
        *tables, key = dotted.split(".")
        table = nested
        for name in tables:
            table = table.setdefault(name, {})
        table[key] = value
    return nested
