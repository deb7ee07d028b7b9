"""Scenario files: lookup, inheritance, overrides, validation and output."""

import hashlib
import json
import re
import tomllib
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path as FilePath
from typing import Any

import tomlkit
from pydantic import ValidationError

from hsr8.errors import ModelError, ScenarioError
from hsr8.files.key_lines import lines_of
from hsr8.files.regular import read_text
from hsr8.files.toml import MAX_SIZE, TomlError, parse_toml
from hsr8.keys import Path, depth
from hsr8.mistakes import MAX_LISTED, Mistake, dotted, mistakes_of
from hsr8.robots.scale import DEFAULT_ROBOT, RobotDefaults, RobotScale
from hsr8.scenario.checks import check
from hsr8.scenario.constants import CONSTANTS, misplaced, placed, separated, with_constants
from hsr8.scenario.plugin import KINDS, located_plugins
from hsr8.scenario.presets import expand_presets, followers, merged, under
from hsr8.scenario.reference import FILE_KEYS
from hsr8.scenario.robot import located
from hsr8.scenario.scaling import is_complete, scaled, with_scaled_defaults
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track_file import legible, located_tracks, read_tracks
from hsr8.suggestion import suggestion

BUILT_IN = FilePath(__file__).resolve().parents[1] / "scenarios"
MAX_EXTENDED = 16  # files that extend each other

Table = dict[str, Any]


def built_in_names() -> list[str]:
    """Names of the built-in scenarios."""
    return sorted(path.stem for path in BUILT_IN.glob("*.toml"))


def load_scenario(
    name_or_path: str,
    overrides: Sequence[str] | Mapping[str, Any] = (),
    seed: int | None = None,
    options: Mapping[str, Mapping[str, Any]] | None = None,
    more: Mapping[str, Sequence[str]] | None = None,
    *,
    trust: bool | None = None,
) -> Scenario:
    """Read a scenario.

    Built-in scenarios and all defaults are scaled to the robot. Values in other files and from
    options are literal.

    Args:
        name_or_path: name of a built-in scenario, or a TOML file.
        overrides: ``key=value`` with a dotted key and a TOML value, where text needs no quotes;
            or a mapping from dotted keys to values.
        seed: replaces the seed of the file.
        options: tables set by command-line options, by the option's name; `overrides` take
            precedence.
        more: further ``key=value`` by their source, which messages name, such as ``--vary``;
            these take precedence over all others.
        trust: whether plugins that files name may run; default: those below the folder of
            `name_or_path`. Plugins that overrides name may always run.

    Raises:
        ScenarioError: the file or an override is wrong; the message lists every mistake with its
            line and the allowed values.
    """
    words = [("--set", word) for word in as_words(overrides)]
    words += [(source, word) for source, given in (more or {}).items() for word in given]
    layers = _read(_find(name_or_path), ())
    scenario, draft = _Sources(layers, options or {}, words, seed).scenario(name_or_path)
    _note_untrusted(scenario, draft, trust)
    return scenario


def as_words(overrides: Sequence[str] | Mapping[str, Any]) -> tuple[str, ...]:
    """Return overrides as ``key=value``.

    Raises:
        ScenarioError: a value cannot be written in TOML.
    """
    if isinstance(overrides, str):  # also a sequence of strings
        return (overrides,)
    if not isinstance(overrides, Mapping):
        return tuple(overrides)
    words = []
    for key, value in overrides.items():
        plain = value.tolist() if hasattr(value, "tolist") else value  # NumPy
        try:
            text = tomlkit.item([plain]).as_string()  # in a list, tables are inline
        except ValueError:
            raise ScenarioError(
                f"setting {key}: expected a TOML value, got {type(value).__name__}"
            ) from None
        words.append(f"{key}={text[1:-1]}")
    return tuple(words)


def loads(text: str, name: str = "scenario") -> Scenario:
    """Read a scenario from TOML text; it may extend built-in scenarios only.

    Raises:
        ScenarioError: as `load_scenario`.
    """
    scenario, draft = _Sources(_layered(text, name, name, BUILT_IN, ())).scenario(name)
    _note_untrusted(scenario, draft, trust=False)
    return scenario


def _note_untrusted(scenario: Scenario, draft: "_Draft", trust: bool | None) -> None:
    """Note in the scenario which of its plugins no user named or trusts, and where they are named.

    Args:
        scenario: to note it in.
        draft: tables of the scenario.
        trust: see `load_scenario`.
    """
    if trust:
        return
    for kind in KINDS:
        path, reference = ("plugin", kind), getattr(scenario.plugin, kind)
        layer = draft.layer(path)
        if not reference or layer is None or layer.text is None:
            continue
        (source,) = draft.sources([path])
        folder = FilePath(layer.source).resolve().parent
        file = FilePath(reference.rpartition(":")[0]).resolve()
        if trust is None and file.is_relative_to(folder):
            continue
        scenario.plugin.untrusted[kind] = f"{source}plugin.{kind}"


def dump(scenario: Scenario) -> str:
    """Return a scenario as TOML text; `loads` of it gives an equal scenario.

    All settings are written, and the constants that differ from their defaults; those of another
    robot than HSR-VIII all are, so that nothing is left to scale.
    """
    return tomlkit.dumps(legible(tables(scenario)))


def tables(scenario: Scenario) -> Table:
    """Return the tables that `dump` writes."""
    return separated(json.loads(scenario.model_dump_json(exclude_none=True)))


@dataclass
class _Layer:
    """Tables from one file or option."""

    table: Table
    source: str
    text: str | None = None  # of a file
    built_in: bool = False

    def locations(self, paths: Sequence[Path]) -> dict[Path, str]:
        """File and line, or option, that gives the key at each path."""
        lines = {} if self.text is None else lines_of(self.text, paths)
        return {p: f"{self.source}:{lines[p]}" if p in lines else self.source for p in paths}


@dataclass
class _Sources:
    """Files, tables of options, and overrides with their flags, in ascending precedence."""

    layers: list[_Layer]
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    words: Sequence[tuple[str, str]] = ()
    seed: int | None = None

    def scenario(self, name: str) -> "tuple[Scenario, _Draft]":
        """Return the scenario for its robot, and its tables.

        Raises:
            ScenarioError: it is wrong.
        """
        try:
            draft = self._draft(RobotDefaults())
            if draft.robot != DEFAULT_ROBOT and not draft.misplaced_keys():
                draft = self._for_robot(draft, name)
            return draft.finish(name), draft
        except RecursionError:
            raise ScenarioError(f"{name}: tables or lists are nested too deeply") from None

    def _for_robot(self, draft: "_Draft", name: str) -> "_Draft":
        """Tables for the robot of a draft; a complete draft needs nothing from its robot."""
        if draft.complete and not any(layer.built_in for layer in self.layers):
            return draft
        try:
            defaults = robot_defaults(draft.robot)
        except ModelError as error:
            raise draft.error(name, [Mistake(("robot", "model"), str(error))]) from error
        return self._draft(defaults)

    def _draft(self, defaults: RobotDefaults) -> "_Draft":
        """All tables for a robot."""
        draft = _Draft(defaults.scale)
        for layer in self.layers:
            if layer.built_in:  # extends built-in scenarios only
                draft.add(layer)
        draft.data = merged(placed(defaults.table), _for_scale(draft.data, defaults.scale))
        for layer in self.layers:
            if not layer.built_in:
                draft.add(layer)
        for option, options in self.options.items():
            draft.add(_Layer(dict(options), option))
        for flag, word in self.words:
            draft.add(_Layer(_parse_override(word, draft.data, flag), f"{flag} {word}"))
        if self.seed is not None:
            draft.add(_Layer({"seed": self.seed}, "--seed"))
        return draft


@dataclass
class _Draft:
    """Merged tables, the layers they consist of, and the scale of all defaults."""

    scale: RobotScale
    data: Table = field(default_factory=dict)
    layers: list[_Layer] = field(default_factory=list)

    @property
    def robot(self) -> str:
        """Name or file of the robot; that of HSR-VIII while the value is wrong."""
        robot = self.data.get("robot")
        model = robot.get("model", DEFAULT_ROBOT) if isinstance(robot, dict) else DEFAULT_ROBOT
        return model if isinstance(model, str) else DEFAULT_ROBOT

    @property
    def complete(self) -> bool:
        """Whether all quantities are given."""
        return is_complete(self._tables())

    def misplaced_keys(self) -> list[Mistake]:
        """Return the keys of the libraries that are not where they belong."""
        return _first(misplaced(self.data))

    def add(self, layer: _Layer) -> None:
        """Merge a layer over the present tables."""
        folder = FilePath(layer.source).parent
        table = located_tracks(located(layer.table, folder), folder)
        if layer.text is not None:
            table = located_plugins(table, folder)
        self.data = merged(self.data, table)
        self.layers.append(layer)

    def finish(self, name: str) -> Scenario:
        """Return the scenario after all checks.

        Raises:
            ScenarioError: it is wrong.
        """
        scenario, problems = self._validated()
        if problems or scenario is None:
            raise self.error(name, problems)
        return scenario

    def _validated(self) -> tuple[Scenario | None, list[Mistake]]:
        if problems := self.misplaced_keys():
            return None, problems
        data = self._tables()
        if self.scale != RobotScale():
            data = with_scaled_defaults(data, self.scale.factor)
        data = expand_presets(data)
        if problems := read_tracks(data):
            return None, problems
        try:
            scenario = Scenario.model_validate_json(json.dumps(data, default=str))
        except ValidationError as error:
            return None, _first(mistakes_of(error, Scenario, data, FILE_KEYS))
        return scenario, _first(check(scenario))

    def _tables(self) -> Table:
        """Tables with the constants in their sections."""
        return with_constants(under(self.data, followers(self.data)))

    def error(self, name: str, problems: Sequence[Mistake]) -> ScenarioError:
        """Return the error that lists the first problems with their places."""
        count = "1 mistake" if len(problems) == 1 else f"{len(problems)} mistakes"
        if len(problems) > MAX_LISTED:
            count, problems = f"the first {MAX_LISTED} mistakes", problems[:MAX_LISTED]
        lines = [f"{count} in scenario {name!r}"]
        paths = [self._path(problem.path) for problem in problems]
        for source, path, problem in zip(self.sources(paths), paths, problems, strict=True):
            lines.append(f"  {source}{dotted(path) or 'scenario'}: {problem.text}")
        return ScenarioError("\n".join(lines))

    def _path(self, path: Path) -> Path:
        """Path of a key as given, which may be a constant."""
        if depth(self.data, path) < len(path) <= depth(self.data.get(CONSTANTS), path):
            return (CONSTANTS, *path)
        return path

    def layer(self, path: Path) -> _Layer | None:
        """Return the layer that gives the longest part of `path`, the last one of several."""
        depths = [depth(layer.table, path) for layer in self.layers]
        deepest = max(depths, default=0)
        if not deepest:
            return None
        return self.layers[max(k for k, d in enumerate(depths) if d == deepest)]

    def sources(self, paths: Sequence[Path]) -> list[str]:
        """Source of the longest given part of each path, with a colon; empty without one."""
        layers = [self.layer(path) for path in paths]
        sources = dict.fromkeys(paths, "")
        for layer in self.layers:
            within = [path for path, of in zip(paths, layers, strict=True) if of is layer]
            sources |= {path: f"{source}: " for path, source in layer.locations(within).items()}
        return [sources[path] for path in paths]


def _first(problems: Iterable[Mistake]) -> list[Mistake]:
    """The problems of a message, and one more if there are more."""
    return list(islice(problems, MAX_LISTED + 1))


def _for_scale(table: Table, scale: RobotScale) -> Table:
    """Tables for HSR-VIII at another scale."""
    return table if scale == RobotScale() else scaled(table, scale.factor)


def _find(name_or_path: str) -> FilePath:
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


def _read(file: FilePath, above: tuple[FilePath, ...]) -> list[_Layer]:
    try:
        text = read_text(file, MAX_SIZE)
    except FileNotFoundError:
        hint = suggestion(file.name, _files(file.parent))
        raise ScenarioError(f"scenario file {str(file)!r} does not exist{hint}") from None
    except OSError as error:
        raise ScenarioError(f"scenario file {str(file)!r}: {error.strerror}") from None
    return _layered(text, str(file), file.stem, file.parent, (*above, file))


def _layered(
    text: str, source: str, stem: str, folder: FilePath, files: tuple[FilePath, ...]
) -> list[_Layer]:
    """The layers of the scenario that `text` extends, and `text`."""
    try:
        data = parse_toml(text)
    except TomlError as error:
        raise ScenarioError(f"{source}: {error}") from None
    data.setdefault("name", _name(stem))
    built_in = bool(files) and files[-1].parent == BUILT_IN
    layer = _Layer(data, source, text, built_in)
    layers: list[_Layer] = []
    if "extends" in data:
        key = ("extends",)
        location = f"{layer.locations([key])[key]}: extends"
        layers = _read(_parent(data.pop("extends"), location, folder, files), files)
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


def _parse_override(override: str, data: Table, flag: str) -> Table:
    """Nested table of ``a.b=value``; lists are copied with one entry changed."""
    source = f"{flag} {override}"
    key, equals, text = override.partition("=")
    parts = key.strip().split(".")
    if not equals or not all(parts):
        raise ScenarioError(f"{source}: expected key=value, for example {flag} camera.period_ms=80")
    if parts == ["extends"]:
        raise ScenarioError(f"{source}: extends is allowed in files only")
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        parsed = {"value": text.strip()}
    value = parsed["value"] if len(parsed) == 1 else text
    for k in range(len(parts) - 1, 0, -1):
        value = _put(parts[k], value, _at(data, parts[:k]), source)
    return {parts[0]: value}


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


def robot_defaults(model: str) -> RobotDefaults:
    """Return the defaults of a robot.

    Raises:
        ModelError: the robot cannot be loaded.
    """
    from hsr8.robots.defaults import defaults_of  # noqa: PLC0415 (MuJoCo loads slowly)

    return defaults_of(model)
