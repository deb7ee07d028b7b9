"""Common definition of the runs of a sweep: scenario, versions and code."""

import hashlib
import json
import platform
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hsr8.errors import ScenarioError
from hsr8.files.tables import flatten
from hsr8.files.text import shell_line
from hsr8.recording.manifest import code_digest, versions_of
from hsr8.scenario.layers import Table
from hsr8.scenario.loader import dump, loads, tables
from hsr8.scenario.schema import Scenario
from hsr8.version import VERSION

MAX_TEXT = 1000  # of a value in a message [characters]
MAY_DIFFER = ("seed", "description")  # keys of a scenario, within a sweep

Differences = dict[str, tuple[str, str]]


@dataclass(frozen=True, slots=True)
class Definition:
    """Scenario, versions and code of a sweep.

    Attributes:
        name: name of the scenario.
        command_words: command line of one run without its seed; of a run folder, with it.
        hsr8: version.
        code: digest of the program's files.
        processor: architecture; results are bit-exact on the same architecture only.
        libraries: version by name.
        scenario: resolved scenario as TOML; its seed is ignored.
    """

    name: str
    command_words: tuple[str, ...]
    hsr8: str
    code: str
    processor: str
    libraries: dict[str, str]
    scenario: str

    @classmethod
    def now(cls, scenario: Scenario, command_words: tuple[str, ...]) -> "Definition":
        """Return the definition of a scenario with the installed versions.

        Raises:
            UsageError: a plugin cannot be read.
        """
        return cls(
            name=scenario.name,
            command_words=command_words,
            hsr8=VERSION,
            code=code_digest(),
            processor=platform.machine(),
            libraries=versions_of(scenario),
            scenario=dump(scenario),
        )

    def command(self, seed: int) -> str:
        """Return the command line that repeats the run of `seed`."""
        return shell_line([*self.command_words, "--seed", str(seed)])

    @classmethod
    def from_json(cls, value: Mapping[str, Any]) -> "Definition":
        """Read the attributes by name.

        Raises:
            KeyError, TypeError, ValueError: `value` is not a definition.
        """
        tomllib.loads(value["scenario"])
        words = tuple(map(str, value["command_words"]))
        return cls(**{**value, "command_words": words, "libraries": dict(value["libraries"])})

    def versions(self) -> dict[str, str]:
        """Return all versions by name."""
        return {
            "hsr8": self.hsr8,
            "code": self.code,
            "processor": self.processor,
            **self.libraries,
        }

    def made_with(self) -> str:
        """Return the versions as one line."""
        names = ("mujoco", "numpy", "scipy", "pin")
        libraries = ", ".join(f"{name} {self.libraries.get(name, '?')}" for name in names)
        arithmetic = self.libraries.get("arithmetic", "native")
        machine = f"{self.processor}, arithmetic {arithmetic}"
        return f"hsr8 {self.hsr8} (code {self.code}), {libraries}; {machine}"


def scenario_differences(one: Definition, other: Definition) -> Differences:
    """Return the scenario keys whose values differ, with both values as JSON; absent is ``-``."""
    return table_differences(_resolved(one.scenario), _resolved(other.scenario))


def table_differences(one: Table, other: Table) -> Differences:
    """Return `scenario_differences` of two scenarios as tables."""
    texts = ({key: _text(value) for key, value in flatten(t).items()} for t in (one, other))
    pairs = differences(*texts)
    return {key: pairs[key] for key in sorted(pairs.keys() - set(MAY_DIFFER))}


def version_differences(one: Definition, other: Definition) -> Differences:
    """Return the versions that differ, with both values."""
    return differences(one.versions(), other.versions())


def differences(one: Mapping[str, str], other: Mapping[str, str]) -> Differences:
    """Return the values that differ by key, with both values; absent is ``-``."""
    pairs = {key: (one.get(key, "-"), other.get(key, "-")) for key in {**one, **other}}
    return {key: pair for key, pair in pairs.items() if pair[0] != pair[1]}


def _text(value: object) -> str:
    """Return a value as JSON; of a long one, such as a recorded crowd, its digest."""
    text = json.dumps(value, default=str)
    if len(text) <= MAX_TEXT:
        return text
    digest = hashlib.sha256(text.encode()).hexdigest()[:12]
    return f"{len(text)} characters with the digest {digest}"


def _resolved(text: str) -> Table:
    """Return a scenario of another version with the keys added since."""
    try:
        return tables(loads(text))
    except ScenarioError:
        return tomllib.loads(text)
