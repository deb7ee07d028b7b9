"""Scenarios: reading, completion for their robot, validation and output."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path as FilePath
from typing import Any

import tomlkit
from pydantic import ValidationError

from hsr8.errors import ModelError, ScenarioError
from hsr8.keys import Path, depth
from hsr8.mistakes import MAX_LISTED, Mistake, dotted, mistakes_of
from hsr8.robots.scale import DEFAULT_ROBOT, RobotDefaults, RobotScale
from hsr8.scenario.checks import check
from hsr8.scenario.layers import (
    BUILT_IN,
    Given,
    Layer,
    Setting,
    Table,
    find_scenario,
    layered,
    read_layers,
    settings_of,
)
from hsr8.scenario.plugin import KINDS
from hsr8.scenario.reference import FILE_KEYS
from hsr8.scenario.scaling import (
    expand_presets,
    followers,
    is_complete,
    merged,
    scaled,
    under,
    with_scaled_defaults,
)
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track_file import legible, read_tracks

FORMER = "constants"  # former table of the keys without a text


def load_scenario(
    name_or_path: str,
    overrides: Given = (),
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
    settings = settings_of(overrides)
    settings += [s for source, given in (more or {}).items() for s in settings_of(given, source)]
    layers = read_layers(find_scenario(name_or_path))
    layers += [Layer(dict(table), option) for option, table in (options or {}).items()]
    return _scenario(name_or_path, layers, settings, seed, trust=trust)


def loads(text: str, name: str = "scenario") -> Scenario:
    """Read a scenario from TOML text; it may extend built-in scenarios only.

    Raises:
        ScenarioError: as `load_scenario`.
    """
    return _scenario(name, layered(text, name, name, BUILT_IN, ()), trust=False)


def _note_untrusted(scenario: Scenario, draft: "_Draft", trust: bool | None) -> None:
    """Note in the scenario which of its plugins no user named or trusts, and where they are named.

    Args:
        scenario: scenario that receives the note.
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

    All values are written, so that nothing is left to scale.
    """
    return tomlkit.dumps(legible(tables(scenario)))


def tables(scenario: Scenario) -> Table:
    """Return the tables that `dump` writes."""
    return dict(json.loads(scenario.model_dump_json(exclude_none=True)))


def _scenario(
    name: str,
    layers: Sequence[Layer],
    settings: Sequence[Setting] = (),
    seed: int | None = None,
    *,
    trust: bool | None,
) -> Scenario:
    """Return the scenario of some layers.

    Args:
        name: name in messages.
        layers: files and tables of options in ascending precedence.
        settings: single values, which take precedence.
        seed: seed that takes precedence over all others.
        trust: see `load_scenario`.

    Raises:
        ScenarioError: it is wrong.
    """
    try:
        draft = _draft(name, layers, settings)
        if seed is not None:
            draft.add(Layer({"seed": seed}, "--seed"))
        scenario = draft.finish(name)
    except RecursionError:
        raise ScenarioError(f"{name}: tables or lists are nested too deeply") from None
    _note_untrusted(scenario, draft, trust)
    return scenario


def _draft(name: str, layers: Sequence[Layer], settings: Sequence[Setting]) -> "_Draft":
    """Return the merged tables; the built-in ones and all defaults are those of the robot.

    A complete scenario needs nothing from its robot, which may be missing.

    Raises:
        ScenarioError: an override is wrong, or the robot is.
    """
    given = [*layers, *(Layer(setting.table({}), setting.source) for setting in settings)]
    model, draft = _robot_of(given), _Draft()
    built_in = [layer for layer in layers if layer.built_in]  # they extend built-in ones only
    for layer in built_in:
        draft.add(layer)
    defaults = RobotDefaults()
    if built_in and model != DEFAULT_ROBOT:
        defaults = _defaults(model, name, given)
        draft.data = scaled(draft.data, defaults.scale.factor)
    for layer in layers[len(built_in) :]:
        draft.add(layer)
    for setting in settings:
        draft.add(Layer(setting.table(draft.data), setting.source))
    if not (built_in or model == DEFAULT_ROBOT or draft.complete):
        defaults = _defaults(model, name, given)
    draft.data, draft.scale = under(draft.data, defaults.table), defaults.scale
    return draft


def _robot_of(layers: Sequence[Layer]) -> str:
    """Return the name or file of the robot; that of HSR-VIII while the value is wrong."""
    model: Any = DEFAULT_ROBOT
    for layer in layers:
        robot = layer.located().get("robot")
        model = robot.get("model", model) if isinstance(robot, dict) else model
    return model if isinstance(model, str) else DEFAULT_ROBOT


def _defaults(model: str, name: str, layers: list[Layer]) -> RobotDefaults:
    """Return the defaults of a robot.

    Raises:
        ScenarioError: the robot cannot be loaded.
    """
    try:
        return robot_defaults(model)
    except ModelError as error:
        mistake = Mistake(("robot", "model"), str(error))
        raise _Draft(layers=layers).error(name, [mistake]) from error


@dataclass
class _Draft:
    """Merged tables.

    Attributes:
        scale: scale of the defaults that are missing.
        data: tables.
        layers: layers that they consist of.
    """

    scale: RobotScale = field(default_factory=RobotScale)
    data: Table = field(default_factory=dict)
    layers: list[Layer] = field(default_factory=list)

    @property
    def complete(self) -> bool:
        """Whether all quantities are given."""
        return is_complete(self._tables())

    def add(self, layer: Layer) -> None:
        """Merge a layer over the present tables."""
        self.data = merged(self.data, layer.located())
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
        if problems := _first(_former(self.data)):
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
        """Tables with the defaults that follow given keys."""
        return under(self.data, followers(self.data))

    def error(self, name: str, problems: Sequence[Mistake]) -> ScenarioError:
        """Return the error that lists the first problems with their places."""
        count = "1 mistake" if len(problems) == 1 else f"{len(problems)} mistakes"
        if len(problems) > MAX_LISTED:
            count, problems = f"the first {MAX_LISTED} mistakes", problems[:MAX_LISTED]
        lines = [f"{count} in scenario {name!r}"]
        paths = [problem.path for problem in problems]
        for source, path, problem in zip(self.sources(paths), paths, problems, strict=True):
            lines.append(f"  {source}{dotted(path) or 'scenario'}: {problem.text}")
        return ScenarioError("\n".join(lines))

    def layer(self, path: Path) -> Layer | None:
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


def _former(data: Table) -> Iterator[Mistake]:
    """Yield the keys of the former table ``[constants]``, with their present place."""
    tables: list[tuple[Path, Any]] = [((FORMER,), data.get(FORMER))]
    for path, value in tables:  # grows
        if isinstance(value, dict):
            tables += [((*path, key), inner) for key, inner in value.items()]
        elif len(path) > 1:
            yield Mistake(path, f"former key; expected {dotted(path[1:])}")


def _first(problems: Iterable[Mistake]) -> list[Mistake]:
    """The problems of a message, and one more if there are more."""
    return list(islice(problems, MAX_LISTED + 1))


def robot_defaults(model: str) -> RobotDefaults:
    """Return the defaults of a robot.

    Raises:
        ModelError: the robot cannot be loaded.
    """
    from hsr8.robots.defaults import defaults_of  # noqa: PLC0415 (MuJoCo loads slowly)

    return defaults_of(model)
