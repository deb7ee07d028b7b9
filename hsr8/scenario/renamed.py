"""Old names of the keys and values of a scenario: refused with the new name."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hsr8.scenario.problem import Problem, shown
from hsr8.scenario.toml_lines import Path

# Old key -> new key, both with dots, without indices of lists; a section covers the keys below it.
# Sorted, one entry per line.
RENAMED: dict[str, str] = {
    "own": "plugin",
    "vision.colour_table": "vision.color_table",
    "world.mover.colour": "world.mover.color",
    "world.obstacle.colour": "world.obstacle.color",
    "world.row": "world.wall",
}

# Key -> old value -> new value.
RENAMED_VALUES: dict[str, dict[str, str]] = {
    "camera.source": {"all-round": "omnidirectional", "egl": "rendered"},
}

CONSTANTS = "constants"  # the table of constants has the same keys


def renamed(data: Any, path: Path = ()) -> Iterator[Problem]:
    """Old keys and values in the tables of a scenario.

    Args:
        data: value at `path`.
        path: of the keys around it.
    """
    names = [part for part in path if isinstance(part, str)]
    prefix = names[:1] if names[:1] == [CONSTANTS] else []
    old = ".".join(names[len(prefix) :])
    if not isinstance(data, Mapping) and (new := _new_key(old)):
        yield Problem(path, f"renamed to {'.'.join([*prefix, new])}")
    elif isinstance(data, str) and data in (values := RENAMED_VALUES.get(old, {})):
        yield Problem(path, f'{shown(data)} is renamed to "{values[data]}"')
    elif isinstance(data, Mapping):
        for key, value in data.items():
            yield from renamed(value, (*path, key))
    elif isinstance(data, Sequence) and not isinstance(data, str):
        for k, value in enumerate(data):
            yield from renamed(value, (*path, k))


def _new_key(old: str) -> str:
    """New key for an old one; empty if it is not renamed."""
    section, rest = old, ""
    while section:
        if section in RENAMED:
            return RENAMED[section] + rest
        section, dot, key = section.rpartition(".")
        rest = f"{dot}{key}{rest}"
    return ""
