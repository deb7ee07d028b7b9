"""Scenario files: found, inherited, overridden, checked, and written again."""

import json
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

from pydantic import ValidationError

from hsr8.errors import ScenarioError
from hsr8.scenario.checks import check
from hsr8.scenario.presets import expand_presets
from hsr8.scenario.problem import Problem, problems_of
from hsr8.scenario.renamed import renamed
from hsr8.scenario.schema import Scenario
from hsr8.scenario.toml_lines import Path, locate, nearest
from hsr8.scenario.toml_writer import toml_value, write_toml
from hsr8.suggestion import suggestion

BUILT_IN = FilePath(__file__).resolve().parents[1] / "scenarios"
LARGEST = 1_000_000  # a scenario file is not longer than this [byte]
KINDS = ("kind", "motion")  # keys that say which other keys a table has
DEEPEST = 8  # files that may extend one another
MOST_NESTED = 40  # tables and lists in one another

Table = dict[str, Any]


def built_in_names() -> list[str]:
    """Names of the scenarios that come with the program."""
    return sorted(path.stem for path in BUILT_IN.glob("*.toml"))


def load_scenario(
    name_or_path: str,
    overrides: Sequence[str] | Mapping[str, Any] = (),
    seed: int | None = None,
    options: Mapping[str, Mapping[str, Any]] | None = None,
    varied: Sequence[str] = (),
) -> Scenario:
    """Read a scenario.

    Args:
        name_or_path: name of a built-in scenario, or a TOML file.
        overrides: ``key=value`` with dots in the key and a TOML value, of which text needs no
            quotes; or values by key with dots.
        seed: replaces the seed of the file.
        options: tables given by options of the command line, by the option's name; the
            overrides go over them.
        varied: ``key=value`` of ``--vary``, over all of these.

    Raises:
        ScenarioError: the file or an override is wrong; the message lists every mistake
            with its place and what is allowed.
    """
    file = _find(name_or_path)
    draft = _read(file, ())
    for option, table in (options or {}).items():
        draft.add(dict(table), option)
    for flag, words in (("--set", as_words(overrides)), ("--vary", varied)):
        for word in words:
            draft.add(_parse_override(word, draft.data, flag), f"{flag} {word}")
    if seed is not None:
        draft.add({"seed": seed}, "--seed")
    return draft.finish(name_or_path)


def as_words(overrides: Sequence[str] | Mapping[str, Any]) -> tuple[str, ...]:
    """Overrides as the command line has them.

    Raises:
        ScenarioError: a value has no TOML form.
    """
    if isinstance(overrides, str):  # a sequence of texts, too
        return (overrides,)
    if not isinstance(overrides, Mapping):
        return tuple(overrides)
    words = []
    for key, value in overrides.items():
        try:
            words.append(f"{key}={toml_value(value)}")
        except TypeError as error:
            raise ScenarioError(f"setting {key} = {value!r}: there is {error}") from None
    return tuple(words)


def loads(text: str, name: str = "scenario") -> Scenario:
    """Read a scenario from TOML text; it may extend built-in scenarios only.

    Raises:
        ScenarioError: as `load_scenario`.
    """
    return _layered(text, name, name, BUILT_IN, ()).finish(name)


def dump(scenario: Scenario) -> str:
    """TOML text of `scenario`, every key resolved; reading it gives an equal scenario."""
    return write_toml(json.loads(scenario.model_dump_json(exclude_none=True)))


@dataclass
class _Draft:
    """Tables merged so far, and where each key was given."""

    data: Table = field(default_factory=dict)
    places: dict[Path, str] = field(default_factory=dict)

    def add(self, table: Table, place: str, lines: dict[Path, int] | None = None) -> None:
        """Put `table` over what is there; `place` names its source."""
        lines = lines or {}
        self.data = _merged(self.data, table)
        for path, value in _items(table, ()):
            if not isinstance(value, dict):
                self._forget(path)
            line = nearest(lines, path)
            self.places[path] = place if line is None else f"{place}:{line}"

    def finish(self, name: str) -> Scenario:
        """Check everything."""
        if problems := list(renamed(self.data)):
            raise self._error(name, problems)
        data = expand_presets(self.data)
        try:
            scenario = Scenario.model_validate_json(json.dumps(data, default=str))
        except ValidationError as error:
            raise self._error(name, problems_of(error, data)) from None
        problems = check(scenario)
        if problems:
            raise self._error(name, problems)
        return scenario

    def _forget(self, path: Path) -> None:
        for known in [p for p in self.places if p[: len(path)] == path]:
            del self.places[known]

    def _error(self, name: str, problems: list[Problem]) -> ScenarioError:
        count = "1 mistake" if len(problems) == 1 else f"{len(problems)} mistakes"
        lines = [f"{count} in scenario {name!r}"]
        for problem in problems:
            place = nearest(self.places, problem.path)
            where = f"{place}: " if place else ""
            lines.append(f"  {where}{problem.key()}: {problem.text}")
        return ScenarioError("\n".join(lines))


def _merged(base: Table, over: Table) -> Table:
    """`over` put over `base`, table by table."""
    # Another kind of mission, fault or mover has other keys: nothing of the old one is kept.
    changed = any(key in over and over[key] != base.get(key, over[key]) for key in KINDS)
    merged = {} if changed else dict(base)
    for key, value in over.items():
        old = merged.get(key)
        if isinstance(value, dict) and isinstance(old, dict):
            merged[key] = _merged(old, value)
        else:
            merged[key] = value
    return merged


def _find(name_or_path: str) -> FilePath:
    names = built_in_names()
    if name_or_path in names:
        return BUILT_IN / f"{name_or_path}.toml"
    path = FilePath(name_or_path)
    if path.suffix == ".toml" or len(path.parts) > 1:
        return path
    hint = suggestion(f"{name_or_path}.toml", _files(path.parent))
    hint = suggestion(name_or_path, names) or hint
    raise ScenarioError(
        f"no scenario is called {name_or_path!r}{hint} "
        f"(built in: {', '.join(names)}; or give a .toml file)"
    )


def _files(folder: FilePath) -> list[str]:
    """Names of the scenario files in a folder."""
    return sorted(file.name for file in folder.glob("*.toml") if file.is_file())


def _read(file: FilePath, above: tuple[FilePath, ...]) -> _Draft:
    try:
        if not file.is_file():
            reason = f"does not exist{suggestion(file.name, _files(file.parent))}"
            if file.is_symlink():
                reason = f"is a link to {str(file.readlink())!r}, which does not exist"
            if file.exists():
                reason = "is no file; give a scenario's name or a .toml file"
            raise ScenarioError(f"scenario file {str(file)!r} {reason}")
        with file.open("rb") as stream:
            raw = stream.read(LARGEST + 1)
    except (OSError, ValueError) as error:
        raise ScenarioError(f"scenario file {str(file)!r} cannot be read: {error}") from None
    if len(raw) > LARGEST:
        raise ScenarioError(f"scenario file {str(file)!r} is longer than {LARGEST:,} bytes")
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ScenarioError(f"scenario file {str(file)!r} is no UTF-8 text: {error}") from None
    return _layered(text, str(file), file.stem, file.parent, (*above, file))


def _layered(
    text: str, source: str, stem: str, folder: FilePath, files: tuple[FilePath, ...]
) -> _Draft:
    """What `text` extends, and `text` over it."""
    try:
        data = tomllib.loads(text)
    except RecursionError:
        raise ScenarioError(f"{source}: tables or lists are nested too deeply") from None
    except ValueError as error:
        raise ScenarioError(f"{source}: no valid TOML: {error}") from None
    _require_shallow(data, source)
    lines = locate(text, data)
    data.setdefault("name", _name(stem))
    draft = _Draft()
    if "extends" in data:
        place = f"{source}:{lines.get(('extends',), 1)}: extends"
        draft = _read(_parent(data.pop("extends"), place, folder, files), files)
    draft.add(data, source, lines)
    return draft


def _name(stem: str) -> str:
    """Name of a scenario for the name of its file, which may hold anything."""
    return (re.sub(r"[^A-Za-z0-9._-]+", "-", stem).lstrip("._-") or "scenario")[:64]


def _parent(name: object, place: str, folder: FilePath, files: tuple[FilePath, ...]) -> FilePath:
    """File of a scenario that another one extends: built in, or in the same folder."""
    if not isinstance(name, str):
        raise ScenarioError(f"{place}: must be the name of a scenario, got {name!r}")
    if name in built_in_names():
        parent = BUILT_IN / f"{name}.toml"
    elif name.endswith(".toml") and FilePath(name).name == name:
        parent = folder / name
    else:
        hint = suggestion(name, built_in_names())
        raise ScenarioError(
            f"{place}: no scenario is called {name!r}{hint} (built in: "
            f"{', '.join(built_in_names())}; or a .toml file in the same folder)"
        )
    if parent in files or len(files) >= DEEPEST:
        chain = " -> ".join(str(f) for f in (*files, parent))
        raise ScenarioError(f"{place}: scenarios extend one another in a circle: {chain}")
    return parent


def _parse_override(override: str, data: Table, flag: str) -> Table:
    """Nested table of ``a.b=value``; lists are copied with one entry changed."""
    place = f"{flag} {override}"
    if any("\ud800" <= character <= "\udfff" for character in override):
        raise ScenarioError(f"{place}: is no UTF-8 text")
    key, equals, text = override.partition("=")
    parts = key.strip().split(".")
    if not equals or not all(parts):
        raise ScenarioError(f"{place}: must be key=value, for example {flag} camera.period_ms=80")
    if parts == ["extends"]:
        raise ScenarioError(
            f"{place}: a setting cannot change what a scenario extends; give that scenario's name"
        )
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        parsed = {"value": text.strip()}
    value = parsed["value"] if len(parsed) == 1 else text
    for k in range(len(parts) - 1, 0, -1):
        value = _put(parts[k], value, _at(data, parts[:k]), place)
    table = {parts[0]: value}
    _require_shallow(table, place)
    return table


def _require_shallow(data: Any, place: str) -> None:
    """Refuse what goes deeper than can be gone through.

    Raises:
        ScenarioError: it does.
    """
    level = [data]
    for _ in range(MOST_NESTED):
        tables = [value for value in level if isinstance(value, dict | list)]
        level = [v for t in tables for v in (t.values() if isinstance(t, dict) else t)]
    if level:
        raise ScenarioError(f"{place}: tables or lists are nested too deeply")


def _put(part: str, value: Any, there: Any, place: str) -> Any:
    if not isinstance(there, list):
        return {part: value}
    if not part.isdecimal() or int(part) >= len(there):
        raise ScenarioError(
            f"{place}: {part!r} is no entry of a list of {len(there)}, count from 0"
        )
    old = there[int(part)]
    if isinstance(old, dict) and isinstance(value, dict):
        value = _merged(old, value)
    return [*there[: int(part)], value, *there[int(part) + 1 :]]


def _at(data: Any, parts: Sequence[str]) -> Any:
    for part in parts:
        if isinstance(data, list) and part.isdecimal() and int(part) < len(data):
            data = data[int(part)]
        elif isinstance(data, dict):
            data = data.get(part)
        else:
            return None
    return data


def _items(value: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    """Path and value of every table, key and list entry in `value`, the outer ones first."""
    if path:
        yield path, value
    inner: Iterable[tuple[str | int, Any]] = ()
    if isinstance(value, dict):
        inner = value.items()
    elif isinstance(value, list):
        inner = enumerate(value)
    for key, within in inner:
        yield from _items(within, (*path, key))
