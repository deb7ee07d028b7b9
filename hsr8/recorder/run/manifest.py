"""What a run was made of: versions, seed, machine, and how it ended."""

import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from hsr8 import arithmetic
from hsr8.errors import UsageError
from hsr8.recorder.files import atomic
from hsr8.recorder.log_level import LogLevel
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
FORMAT = 3  # of run folders; those without a number are of format 1
RUNNING = "running"
OWN = "hsr8.run("  # begins the command of a run with a planner or a gaze of one's own


@dataclass(frozen=True, slots=True)
class Manifest:
    """Written when a run starts and again when it ends.

    Attributes:
        scenario: name of the scenario.
        seed: of the run.
        command: command line that repeats it; the call, from `OWN` on, of a run that none can.
        exit_reason: how it ended; ``running`` until then, and for ever after a kill; ``failed``
            where its records could not be written, ``error`` after a mistake of ours.
        started: wall-clock time, ISO 8601.
        renderer: OpenGL renderer of the head camera; ``analytic`` without one.
        hsr8: version.
        python: version.
        machine: operating system and processor.
        libraries: version by name, and the arithmetic in force.
        log: how much the Rerun log holds; empty without one.
        checkpoint: simulated time between two checkpoints, 0 for none [s].
        format: number of the run folder's.
    """

    scenario: str
    seed: int
    command: str
    exit_reason: str
    started: str
    renderer: str
    hsr8: str
    python: str
    machine: str
    libraries: dict[str, str]
    log: str = ""
    checkpoint: int = 0
    format: int = FORMAT

    @classmethod
    def now(cls, scenario: str, seed: int, command: Sequence[str], renderer: str) -> "Manifest":
        """Manifest of a run that starts now, on this machine."""
        return cls(
            scenario=scenario,
            seed=seed,
            command=" ".join(command),
            exit_reason=RUNNING,
            started=datetime.now(UTC).isoformat(timespec="seconds"),
            renderer=renderer,
            hsr8=VERSION,
            python=platform.python_version(),
            machine=f"{platform.system()} {platform.release()} {platform.machine()}",
            libraries=versions(),
        )

    @classmethod
    def read(cls, given: Mapping[str, Any], path: Path) -> "Manifest":
        """Manifest of the run in `path` that goes on.

        Raises:
            UsageError: something is missing in `given`, or says nothing about log or checkpoints.
        """
        names = [field.name for field in fields(cls)]
        missing = [name for name in names if name not in given]
        if missing:
            raise UsageError(f"the manifest of {path} lacks {', '.join(missing)}")
        log, checkpoint = given["log"], given["checkpoint"]
        if log not in ("", *LogLevel):
            raise UsageError(f"the manifest of {path} names no level of the log: {log!r}")
        if not isinstance(checkpoint, int) or checkpoint < 0:
            raise UsageError(f"the manifest of {path} names no time of checkpoints: {checkpoint!r}")
        return replace(cls(**{name: given[name] for name in names}), exit_reason=RUNNING)

    @property
    def log_level(self) -> LogLevel | None:
        """How much the Rerun log holds; None without one."""
        return LogLevel(self.log) if self.log else None

    def ended(self, exit_reason: str) -> "Manifest":
        """The same run, ended."""
        return replace(self, exit_reason=exit_reason)

    def write(self, path: Path) -> None:
        """Write to `path` at once; on a full disk in place of the one before."""
        atomic.overwrite_json(path, asdict(self))


def other_versions(manifest: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Name, then, now of every library whose version is another than in `manifest`."""
    then, now = manifest.get("libraries"), versions()
    if not isinstance(then, dict):
        return []
    return [(n, str(then[n]), now[n]) for n in then if n in now and then[n] != now[n]]


def versions() -> dict[str, str]:
    """Installed version of every library that shapes a result, and how they calculate."""
    found = {"arithmetic": arithmetic.IN_FORCE}
    for name in LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "missing"
    return found
