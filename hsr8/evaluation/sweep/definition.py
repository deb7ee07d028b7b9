"""Common definition of the runs of a sweep: scenario, versions and code."""

import hashlib
import json
import platform
import shlex
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hsr8.errors import ScenarioError
from hsr8.evaluation.tables import flatten
from hsr8.recorder.run.manifest import versions_of
from hsr8.robots.file.files import models_dir
from hsr8.scenario.layers import Table
from hsr8.scenario.loader import dump, loads, tables
from hsr8.scenario.schema import Scenario
from hsr8.version import VERSION

PACKAGES = ("compilation", "hsr8", "navigation", "walking", "vision")
MAX_TEXT = 1000  # of a value in a message [characters]
# Folders and files of hsr8:
NOT_IN_DIGEST = ("cli", "render", "rerun_log", "evaluation/sweep", "evaluation/bench", "_models")
MAY_DIFFER = ("seed", "description")  # keys of a scenario, within a sweep

Differences = dict[str, tuple[str, str]]


@dataclass(frozen=True, slots=True)
class Definition:
    """Scenario, versions and code of a sweep.

    Attributes:
        name: name of the scenario.
        command_words: command line of one run without its seed; of a run folder, with it.
        hsr8: version.
        code: digest of the program's files; empty if unknown.
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
        return shlex.join([*self.command_words, "--seed", str(seed)])

    def to_json(self) -> dict[str, Any]:
        """Return everything except the scenario, which has its own file."""
        return {key: value for key, value in asdict(self).items() if key != "scenario"}

    @classmethod
    def from_json(cls, value: Mapping[str, Any], scenario: str) -> "Definition":
        """Read the result of `to_json`.

        Raises:
            KeyError, TypeError, ValueError: `value` is not such a result.
        """
        tomllib.loads(scenario)
        words = tuple(map(str, value["command_words"]))
        libraries = dict(value["libraries"])
        return cls(**{**value, "command_words": words, "libraries": libraries}, scenario=scenario)

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
        code = f" (code {self.code})" if self.code else ""
        arithmetic = self.libraries.get("arithmetic", "native")
        return f"hsr8 {self.hsr8}{code}, {libraries}; {self.processor}, arithmetic {arithmetic}"


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


def code_digest() -> str:
    """Return the first digits of the SHA-256 of all files that influence a result."""
    digest = hashlib.sha256()
    for name, file in _files():
        digest.update(name.encode() + b"\0" + hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:12]


def _files() -> Iterator[tuple[str, Path]]:
    for package in PACKAGES:
        spec = find_spec(package)
        assert spec is not None, package
        assert spec.origin is not None, package
        root = Path(spec.origin).parent
        for file in sorted(root.rglob("*.py")):
            name = file.relative_to(root).as_posix()
            if package != "hsr8" or not name.startswith(NOT_IN_DIGEST):
                yield f"{package}/{name}", file
    root = models_dir()
    for file in sorted(root.rglob("*")):
        if file.is_file() and file.suffix not in (".py", ".pyc", ".md"):
            yield f"models/{file.relative_to(root).as_posix()}", file


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
