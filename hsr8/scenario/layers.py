"""Sources of a scenario: files that extend each other, tables of options, and overrides."""

import hashlib
import os
import re
import tomllib
import unicodedata
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from hsr8.errors import ScenarioError
from hsr8.files.text import TomlError, lines_of, parse_toml, read_text
from hsr8.keys import Path
from hsr8.scenario.plugin import KINDS
from hsr8.scenario.scaling import merged
from hsr8.scenario.track_file import track_movers
from hsr8.suggestion import suggestion

BUILT_IN = FilePath(__file__).resolve().parents[1] / "scenarios"
MAX_EXTENDED = 16  # files that extend each other
MAX_SHOWN = 60  # characters of a setting in a message
ROBOT_SUFFIX = ".toml"  # of the file of a robot, which no name has

Table = dict[str, Any]
Given = str | Sequence[str] | Mapping[str, Any]
"""Settings: ``key=value``, several of these, or values by dotted key."""


def built_in_names() -> list[str]:
    """Names of the built-in scenarios."""
    return sorted(path.stem for path in BUILT_IN.glob("*.toml"))


@dataclass(frozen=True, slots=True)
class Setting:
    """Value of one key, which takes precedence over those of files.

    Attributes:
        key: parts of the dotted key.
        value: value as TOML has it.
        source: place of a mistake: option, key and value.
    """

    key: tuple[str, ...]
    value: Any
    source: str

    def table(self, data: Table) -> Table:
        """Return the nested table of the value; lists are copied with one entry changed.

        Args:
            data: tables that it changes.

        Raises:
            ScenarioError: an index is outside its list.
        """
        value = self.value
        for k in range(len(self.key) - 1, 0, -1):
            value = _put(self.key[k], value, _at(data, self.key[:k]), self.source)
        return {self.key[0]: value}


def settings_of(given: Given, flag: str = "--set") -> list[Setting]:
    """Return settings from ``key=value``, where text needs no quotes, or from a mapping.

    Args:
        given: words, or values by dotted key.
        flag: option that gives the words, for messages.

    Raises:
        ScenarioError: a word is not of that form, or a value has another type than those of TOML.
    """
    if isinstance(given, Mapping):
        return [_setting(key, _plain(value, key), "settings") for key, value in given.items()]
    return [_parsed(word, flag) for word in ([given] if isinstance(given, str) else given)]


def _parsed(word: str, flag: str) -> Setting:
    """Return the setting of ``key=value``."""
    shown = word if len(word) <= MAX_SHOWN else f"{word[:MAX_SHOWN]}..."
    source = f"{flag} {shown}"
    key, equals, text = word.partition("=")
    if not equals:
        raise ScenarioError(f"{source}: expected key=value, for example {flag} camera.period_ms=80")
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        parsed = {"value": text.strip()}
    return _setting(key, parsed["value"] if len(parsed) == 1 else text, source)


def _setting(dotted: str, value: Any, source: str) -> Setting:
    key = tuple(dotted.strip().split("."))
    if not all(key):
        raise ScenarioError(
            f"{source}: wrong key, got {dotted!r}; expected a dotted key, such as camera.period_ms"
        )
    if key == ("extends",):
        raise ScenarioError(f"{source}: extends is allowed in files only")
    return Setting(key, value, source)


def _plain(value: Any, key: str) -> Any:
    """Return a value of Python or NumPy as TOML has it."""
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, Mapping):
        return {str(k): _plain(v, key) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v, key) for v in value]
    if not isinstance(value, bool | int | float | str):
        raise ScenarioError(
            f"settings: {key}: wrong type, got {type(value).__name__}; expected a TOML value"
        )
    return value


@dataclass
class Layer:
    """Tables from one file or option.

    Attributes:
        table: tables as given.
        source: file, or option with its value.
        text: text of a file.
        built_in: whether the file is a built-in scenario.
    """

    table: Table
    source: str
    text: str | None = None
    built_in: bool = False

    def located(self) -> Table:
        """Return the tables with absolute paths of the files that they name and that exist.

        Relative paths begin in the folder of the file, else, but for plugins, in the working
        folder.
        """
        table, folder = deepcopy(self.table), FilePath(self.source).parent
        robot, plugin = table.get("robot"), table.get("plugin")
        if isinstance(robot, dict) and str(robot.get("model")).endswith(ROBOT_SUFFIX):
            robot["model"] = _absolute(robot["model"], folder, FilePath())
        for _, mover in track_movers(table):
            mover["file"] = _absolute(mover["file"], folder, FilePath())
        if self.text is not None and isinstance(plugin, dict):
            for kind in plugin.keys() & KINDS:
                file, colon, name = str(plugin[kind]).rpartition(":")
                if colon:
                    plugin[kind] = f"{_absolute(file, folder)}:{name}"
        return table

    def locations(self, paths: Sequence[Path]) -> dict[Path, str]:
        """Return file and line, or option, that gives the key at each path."""
        lines = {} if self.text is None else lines_of(self.text, paths)
        return {p: f"{self.source}:{lines[p]}" if p in lines else self.source for p in paths}


def _absolute(name: str, *folders: FilePath) -> str:
    """Return the absolute path of a file in the first folder that has it, else its name."""
    files = (folder / os.path.expanduser(name) for folder in folders)
    return next((str(file.absolute()) for file in files if os.path.exists(file)), name)


def find_scenario(name_or_path: str) -> FilePath:
    """Return the file of a scenario by the name of a built-in one, or by its path.

    Raises:
        ScenarioError: it is neither.
    """
    names = built_in_names()
    if name_or_path in names:
        return BUILT_IN / f"{name_or_path}.toml"
    path = FilePath(name_or_path)
    if path.suffix == ".toml" or len(path.parts) > 1:
        return path
    hint = suggestion(name_or_path, [*names, *_files(path.parent)])
    raise ScenarioError(
        f"unknown scenario {name_or_path!r}{hint}; expected a .toml file or one of "
        f"{', '.join(names)}"
    )


def _files(folder: FilePath) -> list[str]:
    """Names of the scenario files in a folder."""
    return sorted(file.name for file in folder.glob("*.toml"))


def read_layers(file: FilePath, above: tuple[FilePath, ...] = ()) -> list[Layer]:
    """Return the layers of a scenario file, those that it extends first.

    Args:
        file: scenario file.
        above: files that extend it.

    Raises:
        ScenarioError: a file cannot be read, or the files extend each other in a loop.
    """
    try:
        text = read_text(file)
    except FileNotFoundError:
        hint = suggestion(file.name, _files(file.parent))
        raise ScenarioError(f"scenario file {str(file)!r} does not exist{hint}") from None
    except OSError as error:
        raise ScenarioError(f"scenario file {str(file)!r}: {error.strerror}") from None
    return layered(text, str(file), file.stem, file.parent, (*above, file))


def layered(
    text: str, source: str, stem: str, folder: FilePath, files: tuple[FilePath, ...]
) -> list[Layer]:
    """Return the layers of the scenario that `text` extends, and its own.

    Args:
        text: TOML text.
        source: name of the text in messages.
        stem: name of the scenario, where the text states none.
        folder: folder of the files that it extends.
        files: files that extend it, and its own.

    Raises:
        ScenarioError: as `read_layers`.
    """
    try:
        data = parse_toml(text)
    except TomlError as error:
        raise ScenarioError(f"{source}: {error}") from None
    data.setdefault("name", _name(stem))
    built_in = bool(files) and files[-1].parent == BUILT_IN
    layer = Layer(data, source, text, built_in)
    layers: list[Layer] = []
    if "extends" in data:
        key = ("extends",)
        location = f"{layer.locations([key])[key]}: extends"
        layers = read_layers(_parent(data.pop("extends"), location, folder, files), files)
    return [*layers, layer]


def _name(stem: str) -> str:
    """Name of a scenario from the name of its file: letters and digits of any script."""
    normal = unicodedata.normalize("NFC", stem)
    allowed = "".join(c if c in "._-" or _kind(c) in "LMN" else "\0" for c in normal)
    name = re.sub("\0+", "-", allowed)
    while name and _kind(name[0]) not in "LN":
        name = name[1:]
    if not name:  # of other characters alone
        digest = hashlib.sha256(stem.encode(errors="surrogateescape")).hexdigest()
        return f"scenario-{digest[:8]}"
    return name[:64]


def _kind(character: str) -> str:
    """Unicode's major category: L for letters, M for marks on them, N for digits."""
    return unicodedata.category(character)[0]


def _parent(name: object, source: str, folder: FilePath, files: tuple[FilePath, ...]) -> FilePath:
    """File of the scenario that another one extends: built in, or in the same folder."""
    names = built_in_names()
    if not isinstance(name, str):
        raise ScenarioError(f"{source}: must be the name of a scenario, got {name!r}")
    if name in names:
        parent = BUILT_IN / f"{name}.toml"
    elif name.endswith(".toml") and FilePath(name).name == name:
        parent = folder / name
    else:
        raise ScenarioError(
            f"{source}: unknown scenario {name!r}{suggestion(name, names)}; expected a .toml file "
            f"in the same folder or one of {', '.join(names)}"
        )
    if len(files) > MAX_EXTENDED:
        raise ScenarioError(f"{source}: more than {MAX_EXTENDED} files extend each other")
    if parent in files:
        chain = " -> ".join(str(f) for f in (*files, parent))
        raise ScenarioError(f"{source}: scenarios extend each other in a loop: {chain}")
    return parent


def _put(part: str, value: Any, old: Any, source: str) -> Any:
    """`old` with one entry changed if it is a list, else a new table."""
    if not isinstance(old, list):
        return {part: value}
    if not part.isdecimal() or int(part) >= len(old):
        raise ScenarioError(f"{source}: expected an index from 0 to {len(old) - 1}, got {part!r}")
    entry = old[int(part)]
    if isinstance(entry, dict) and isinstance(value, dict):
        value = merged(entry, value)
    return [*old[: int(part)], value, *old[int(part) + 1 :]]


def _at(data: Any, parts: Sequence[str]) -> Any:
    for part in parts:
        if isinstance(data, list) and part.isdecimal() and int(part) < len(data):
            data = data[int(part)]
        elif isinstance(data, dict):
            data = data.get(part)
        else:
            return None
    return data
