"""Suite of a benchmark: families of worlds, seeds and standard settings, from a small TOML file."""

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Interval, Len
from pydantic import AfterValidator, ValidationError

from hsr8.errors import ScenarioError, UsageError
from hsr8.files.tables import flatten
from hsr8.files.text import TomlError, parse_toml, read_text
from hsr8.mistakes import mistake_lines
from hsr8.scenario.loader import load_scenario, tables
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Section
from hsr8.sweep.definition import Differences, table_differences
from hsr8.sweep.seeds import parse_seeds

SHIPPED = Path(__file__).with_name("suite.toml")
FREE = ("walking", "vision", "belief", "navigation", "plugin", "recorder", "description", "seed")
"""Sections and keys that do not belong to the suite, with the following exceptions."""
NOT_FREE = ("walking.head", "navigation.mission")
CONDITIONS = ("robot.body", "camera", "sensors", "walking.head")
"""Sections and keys of the suite that an entry may change; its results name the changes."""


def checked_name(name: str) -> str:
    """Return the name of a suite or an entry.

    Raises:
        ValueError: it is not a name.
    """
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}", name):
        raise ValueError(
            f"wrong form, got {name!r}; expected letters, digits, '.', '_' and '-', at most 64, "
            "the first a letter or digit"
        )
    return name


def _without_plugins(settings: tuple[str, ...]) -> tuple[str, ...]:
    for setting in settings:
        if setting.partition("=")[0].strip().split(".")[0].strip() == "plugin":
            raise ValueError(f"a suite names no plugins, got {setting}; expected --set {setting}")
    return settings


class Suite(Section):
    """Families of worlds with their seeds and the standard robot, body and camera."""

    name: Annotated[str, AfterValidator(checked_name)]
    """Name of the suite."""
    version: Annotated[int, Interval(ge=1)]
    """Version; results of different versions are not comparable."""
    quick: str
    """Seeds of every family with ``--quick``, such as ``1000:1008``."""
    full: str
    """Seeds of every family otherwise."""
    settings: Annotated[tuple[str, ...], AfterValidator(_without_plugins)] = ()
    """Standard settings as KEY=VALUE, without plugins."""
    families: Annotated[dict[str, str], Len(min_length=1)]
    """Subject of each scenario's test, by the scenario's name or its file next to the suite."""

    def paths(self, file: Path) -> dict[str, str]:
        """Return name or file of every scenario by the name of its family.

        Args:
            file: file of the suite.
        """
        return {Path(name).stem: _path(file, name) for name in self.families}

    def scenarios(self, file: Path, settings: Sequence[str] = ()) -> dict[str, Scenario]:
        """Return the scenario of every family by name.

        Args:
            file: file of the suite.
            settings: KEY=VALUE, which override those of the suite.

        Raises:
            ScenarioError: a scenario or a setting is invalid.
        """
        words = {f"{file.name}: settings": self.settings, "--set": settings}
        scenarios = {}
        for name in self.families:
            try:
                scenarios[Path(name).stem] = load_scenario(_path(file, name), more=words)
            except ScenarioError as error:
                if settings:
                    raise
                raise ScenarioError(f"{file}: families.{name}: {error}") from error
        return scenarios

    def digest(self, standard: Mapping[str, Scenario]) -> str:
        """Return the first digits of the SHA-256 of all that makes results comparable.

        These are name, version, seeds, and of every family the world, mission, robot and camera
        with all defaults; not the settings of the algorithms.

        Args:
            standard: scenarios of the suite without settings of an entry.
        """
        fixed = {
            family: {key: value for key, value in _keys(scenario).items() if not _free(key)}
            for family, scenario in standard.items()
        }
        return _sha256([self.name, self.version, self.quick, self.full, fixed])


def read_suite(file: Path) -> Suite:
    """Read a suite.

    Raises:
        UsageError: the file is not a suite.
    """
    try:
        text = read_text(file)
        data = parse_toml(text)
        suite = Suite.model_validate_json(json.dumps(data, default=str))
    except OSError as error:
        raise UsageError(f"--suite {file}: cannot be read: {error.strerror}") from error
    except ValidationError as error:
        lines = [
            f"--suite {file}: not a suite",
            *mistake_lines(error, Suite, data, str(file), text),
        ]
        raise UsageError("\n  ".join(lines)) from error
    except TomlError as error:
        raise UsageError(f"--suite {file}: {error}") from error
    for key in ("quick", "full"):
        parse_seeds(getattr(suite, key), f"--suite {file}: {key}")
    return suite


def changed_settings(
    standard: Mapping[str, Scenario], scenarios: Mapping[str, Scenario]
) -> Differences:
    """Return the settings in which the scenarios of an entry differ from the standard.

    Args:
        standard: scenarios of the suite.
        scenarios: those of the entry.

    Raises:
        UsageError: a setting changes the worlds, the mission or the criteria.
    """
    changed: Differences = {}
    wrong = []
    for family, scenario in scenarios.items():
        differences = table_differences(tables(standard[family]), tables(scenario))
        wrong += [
            f"{family}: {key}: {value}; expected {expected}"
            for key, (expected, value) in differences.items()
            if not (_free(key) or _within(key, CONDITIONS))
        ]
        changed |= differences
    if wrong:
        raise UsageError("\n  ".join(["--set: settings change the suite, got", *wrong]))
    return changed


def scenario_hash(scenario: Scenario) -> str:
    """Return the first digits of the SHA-256 of a scenario without its seed."""
    return _sha256(_keys(scenario.with_seed(0)))


def _path(file: Path, name: str) -> str:
    """Return name or file of the scenario of a family."""
    return str(file.parent / name) if name.endswith(".toml") else name


def _keys(scenario: Scenario) -> dict[str, Any]:
    return flatten(tables(scenario))


def _free(key: str) -> bool:
    return _within(key, FREE) and not _within(key, NOT_FREE)


def _within(key: str, sections: Sequence[str]) -> bool:
    """Return whether a key belongs to one of `sections`."""
    return any(f"{key}.".startswith(f"{section}.") for section in sections)


def _sha256(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:12]
