"""The folder of a run: ``runs/<scenario>/<seed>-<id>/``.

    scenario.toml    scenario, fully resolved
    manifest.json    versions, seed, renderer, exit reason
    metrics.json     results, at the end
    *.arrows         tables of the run, see ``docs/data.md``
    log.rrd          log for the Rerun viewer, after ``hsr8 replay`` or with ``hsr8 run --log``
    video.mp4        after ``hsr8 render`` or with ``hsr8 run --video``
    crash.txt        traceback of an internal error

Tables are written once a second, so the folder of a killed run is complete up to its last second.
"""

import secrets
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pyarrow as pa

from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.recording.manifest import Manifest
from hsr8.recording.stream import ArrowFiles
from hsr8.recording.table import Table
from hsr8.recording.write_errors import NO_ROOM, failure, writing
from hsr8.scenario.loader import dump
from hsr8.scenario.schema import Scenario

SCENARIO = "scenario.toml"
MANIFEST = "manifest.json"
METRICS = "metrics.json"
LOG = "log.rrd"
VIDEO = "video.mp4"


@dataclass
class Memory:
    """Contents of a run in memory.

    Attributes:
        scenario: scenario with the seed of the run.
        tables: Arrow stream of each table that has rows.
        metrics: results.
    """

    scenario: Scenario
    tables: dict[str, pa.Buffer] = field(default_factory=dict)
    metrics: dict[str, Any] = field(default_factory=dict)


class RunFolder:
    """Folder of one run, or its memory: a sink of its recorder.

    Args:
        path: new folder, see `create`; manifest and scenario are written immediately. None keeps
            everything in memory.
        scenario: scenario with the seed of the run.
        command: words of the command line that repeats the run.
        renderer: name of the renderer of the head camera.

    Attributes:
        path: the folder.
        manifest: versions, seed, exit reason.
        memory: contents without a folder.

    Raises:
        RecordingFailed: here and in every method, the folder cannot be written.
        UsageError: a plugin cannot be read.
    """

    def __init__(
        self, path: Path | None, scenario: Scenario, command: Sequence[str], renderer: str
    ) -> None:
        self.path = path
        self.manifest = Manifest.now(scenario, command, renderer)
        self.memory = Memory(scenario) if path is None else None
        self._files = ArrowFiles(path)
        if path is not None:
            with writing(path):
                self.manifest.write(path / MANIFEST)
                atomic.write_text(path / SCENARIO, dump(scenario))

    @staticmethod
    def create(out: Path, scenario: str, seed: int) -> Path:
        """Create a new folder below `out`; existing folders are never overwritten.

        Raises:
            RecordingFailed: the disk is full or read-only.
            UsageError: the folder cannot be created for another reason.
        """
        parent = out / scenario
        try:
            parent.mkdir(parents=True, exist_ok=True)
            while True:
                path = parent / f"{seed}-{secrets.token_hex(3)}"
                try:
                    path.mkdir()
                except FileExistsError:
                    continue
                return path
        except OSError as error:
            reason = f"{error.strerror}; choose another with --out"
            if error.errno in NO_ROOM:
                raise failure(parent, reason) from error
            raise UsageError(f"cannot write the run folder {parent}: {reason}") from error

    def add(self, tables: Mapping[str, Table]) -> None:
        """Append rows to the tables."""
        self._files.add(tables)

    def close(self, exit_reason: str) -> None:
        """Close the files."""
        buffers = self._files.close()
        if self.memory is not None:
            self.memory.tables = buffers

    def end(self, exit_reason: str, **facts: Any) -> None:
        """Complete the manifest.

        Args:
            exit_reason: exit reason of the run.
            facts: further attributes of the manifest that are known at the end.
        """
        self.manifest = replace(
            self.manifest, exit_reason=exit_reason, **{"rows": dict(self._files.rows), **facts}
        )
        if self.path is not None:
            with writing(self.path):
                self.manifest.write(self.path / MANIFEST)

    def write_metrics(self, metrics: dict[str, Any]) -> None:
        """Write the results."""
        if self.memory is not None:
            self.memory.metrics = metrics
        if self.path is not None:
            with writing(self.path):
                atomic.write_json(self.path / METRICS, metrics)


@contextmanager
def new_run_folder(out: Path, scenario: str, seed: int) -> Iterator[Path]:
    """Create a folder as `RunFolder.create` does; remove it if nothing is written into it."""
    parent = out / scenario
    missing = [folder for folder in (parent, *parent.parents) if not folder.exists()]
    path = RunFolder.create(out, scenario, seed)
    try:
        yield path
    finally:
        with suppress(OSError):  # of a folder that is not empty
            for folder in (path, *missing):
                folder.rmdir()
