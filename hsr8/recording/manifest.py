"""Manifest of a run: versions, seed, machine and exit reason."""

import hashlib
import platform
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hsr8.files import atomic
from hsr8.plugins.file import digests
from hsr8.process import arithmetic
from hsr8.robots.file.files import models_dir
from hsr8.robots.file.locate import digest
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track_file import track_digests
from hsr8.version import VERSION

LIBRARIES = (
    "mujoco",
    "rerun-sdk",
    "numpy",
    "scipy",
    "pin",
    "opencv-python-headless",
    "filterpy",
    "pydantic",
    "av",
)
PACKAGES = ("compilation", "hsr8", "navigation", "walking", "vision")
# Folders and files of hsr8 that influence no run:
NOT_IN_DIGEST = ("cli", "show", "export", "sweep", "measure/registry", "_models")
FORMAT = 7  # of run folders; those without a number are of format 1
RUNNING = "running"  # exit reason until the run ends
FAILED = "failed"  # exit reason of a run whose records could not be written
CALL = "hsr8.run("  # begins the command of a run with a planner or gaze object


@dataclass(frozen=True, slots=True)
class Manifest:
    """Facts of a run, written when it starts and again when it ends.

    Attributes:
        scenario: name of the scenario.
        seed: seed of the run.
        command: command line that repeats the run. A run with a planner or gaze object cannot be
            repeated by a command; the call, which begins with `CALL`, takes its place.
        exit_reason: how the run ended. ``running`` until then and after a kill, ``failed`` if the
            records could not be written, ``error`` after an internal error.
        started: wall-clock time, ISO 8601.
        renderer: OpenGL renderer of the head camera, or ``camera.source`` without OpenGL.
        hsr8: version.
        code: digest of the program's files.
        python: version.
        machine: operating system and processor.
        libraries: version by name, and the arithmetic in use.
        format: format number of the run folder.
        rows: number of rows of each table, at the end.
        state_hash: SHA-256 of the last state of the world and the belief.
        wall_time_s: wall time of the run, without compilation [s].
    """

    scenario: str
    seed: int
    command: str
    exit_reason: str
    started: str
    renderer: str
    hsr8: str
    code: str
    python: str
    machine: str
    libraries: dict[str, str]
    format: int = FORMAT
    rows: dict[str, int] = field(default_factory=dict)
    state_hash: str = ""
    wall_time_s: float = 0.0

    @classmethod
    def now(cls, scenario: Scenario, command: Sequence[str], renderer: str) -> "Manifest":
        """Return the manifest of a run that starts now on this machine.

        Raises:
            UsageError: a plugin cannot be read.
        """
        return cls(
            scenario=scenario.name,
            seed=scenario.seed,
            command=" ".join(command),
            exit_reason=RUNNING,
            started=datetime.now(UTC).isoformat(timespec="seconds"),
            renderer=renderer,
            hsr8=VERSION,
            code=code_digest(),
            python=platform.python_version(),
            machine=f"{platform.system()} {platform.release()} {platform.machine()}",
            libraries=versions_of(scenario),
        )

    def write(self, path: Path) -> None:
        """Write to `path` atomically; on a full disk overwrite the file in place."""
        atomic.overwrite_json(path, asdict(self))


def other_versions(manifest: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return name, recorded and installed version of every library that differs."""
    then, now = manifest.get("libraries"), versions()
    if not isinstance(then, dict):
        return []
    return [(n, str(then[n]), now[n]) for n in then if n in now and then[n] != now[n]]


def versions() -> dict[str, str]:
    """Return the installed version of every library that affects results, and the arithmetic."""
    installed = {"arithmetic": arithmetic.IN_FORCE}
    for name in LIBRARIES:
        try:
            installed[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            installed[name] = "missing"
    return installed


def versions_of(scenario: Scenario) -> dict[str, str]:
    """Return `versions`, with the digests of plugins, robot and recordings of a scenario.

    Raises:
        UsageError: a plugin cannot be read.
        ModelError: a file of the robot is missing.
    """
    made = digests(scenario.plugin) | digest(scenario.robot.model)
    return versions() | made | track_digests(scenario.world.mover)


@cache
def code_digest() -> str:
    """Return the first digits of the SHA-256 of all files that influence a result.

    It is computed once per process: the code that runs does not follow later changes of the files.
    """
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
