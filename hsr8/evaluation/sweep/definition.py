"""What all runs of a sweep have in common: scenario, versions, code."""

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
from hsr8.recorder.run.manifest import versions
from hsr8.scenario.loader import dump, loads
from hsr8.version import VERSION
from hsr8.world.model.models import models_dir

PACKAGES = ("hsr8", "navigation", "walking", "vision")
# Folders of hsr8 that do not shape a result.
AROUND = ("cli", "render", "evaluation/sweep")
IGNORED = ("seed", "description")  # keys of a scenario that may differ within a sweep


@dataclass(frozen=True, slots=True)
class Definition:
    """What a sweep runs.

    Attributes:
        name: of the scenario.
        again: words of the command line of one run, without its seed; of a run folder with it.
        hsr8: version.
        code: digest of the program's files; empty where that is not known.
        processor: architecture; results are the same on one only.
        libraries: version by name.
        scenario: the resolved scenario as TOML; its seed means nothing.
    """

    name: str
    again: tuple[str, ...]
    hsr8: str
    code: str
    processor: str
    libraries: dict[str, str]
    scenario: str

    @classmethod
    def now(cls, name: str, again: tuple[str, ...], scenario: str) -> "Definition":
        """Definition with the versions installed here."""
        return cls(
            name=name,
            again=again,
            hsr8=VERSION,
            code=code_digest(),
            processor=platform.machine(),
            libraries=versions(),
            scenario=scenario,
        )

    def command(self, seed: int) -> str:
        """Command line that repeats the run of `seed`."""
        return shlex.join([*self.again, "--seed", str(seed)])

    def to_json(self) -> dict[str, Any]:
        """All but the scenario, which has a file of its own."""
        return {key: value for key, value in asdict(self).items() if key != "scenario"}

    @classmethod
    def from_json(cls, value: Mapping[str, Any], scenario: str) -> "Definition":
        """Read back what `to_json` gave.

        Raises:
            KeyError, TypeError, ValueError: it did not give that.
        """
        tomllib.loads(scenario)
        return cls(
            name=str(value["name"]),
            again=tuple(map(str, value["again"])),
            hsr8=str(value["hsr8"]),
            code=str(value["code"]),
            processor=str(value["processor"]),
            libraries={str(k): str(v) for k, v in dict(value["libraries"]).items()},
            scenario=scenario,
        )

    def made_with(self) -> str:
        """Versions, for the foot of a page."""
        names = ("mujoco", "numpy", "scipy", "pin")
        told = ", ".join(f"{name} {self.libraries.get(name, '?')}" for name in names)
        code = f" (code {self.code})" if self.code else ""  # a run folder does not know
        processor = f"{self.processor}, arithmetic {self.libraries.get('arithmetic', 'native')}"
        return f"hsr8 {self.hsr8}{code}, {told}; {processor}"


def differences(one: Definition, other: Definition) -> dict[str, tuple[str, str]]:
    """Keys of the scenarios whose values differ, with both values as JSON; absent is ``-``."""
    tables = [dict(_flat(tomllib.loads(_resolved(d.scenario)), "")) for d in (one, other)]
    keys = [key for key in {**tables[0], **tables[1]} if key not in IGNORED]
    both = {key: (tables[0].get(key, "-"), tables[1].get(key, "-")) for key in keys}
    return {key: pair for key, pair in sorted(both.items()) if pair[0] != pair[1]}


def version_differences(one: Definition, other: Definition) -> dict[str, tuple[str, str]]:
    """Versions that differ, with both."""
    tables = [
        {"hsr8": d.hsr8, "code": d.code, "processor": d.processor, **d.libraries}
        for d in (one, other)
    ]
    keys = tables[0] | tables[1]
    both = {key: (tables[0].get(key, "-"), tables[1].get(key, "-")) for key in keys}
    return {key: pair for key, pair in both.items() if pair[0] != pair[1]}


def code_digest() -> str:
    """First digits of the SHA-256 of all files that shape a result."""
    digest = hashlib.sha256()
    for name, file in _files():
        digest.update(name.encode() + b"\0" + hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:12]


def _files() -> Iterator[tuple[str, Path]]:
    for package in PACKAGES:
        spec = find_spec(package)
        if spec is None or spec.origin is None:
            continue
        root = Path(spec.origin).parent
        for file in sorted(root.rglob("*.py")):
            name = file.relative_to(root).as_posix()
            if package != "hsr8" or not name.startswith((*AROUND, "_models")):
                yield f"{package}/{name}", file
    root = models_dir()
    for file in sorted(root.rglob("*")):
        if file.is_file() and file.suffix not in (".py", ".pyc", ".md"):
            yield f"models/{file.relative_to(root).as_posix()}", file


def _resolved(text: str) -> str:
    """A scenario of another version, with the keys that are new since then."""
    try:
        return dump(loads(text))
    except ScenarioError:
        return text


def _flat(value: Any, path: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from _flat(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for k, inner in enumerate(value):
            yield from _flat(inner, f"{path}.{k}")
    else:
        yield path, json.dumps(value, default=str)
