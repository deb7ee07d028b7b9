"""Reading of run folders, also of runs that were killed."""

import json
import os
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

from hsr8.errors import ScenarioError, UsageError
from hsr8.file_format import check_number
from hsr8.files.regular import read_text
from hsr8.files.writing import FAILED
from hsr8.recorder.rows import TABLES
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import FORMAT, RUNNING
from hsr8.recorder.stream import SUFFIX, read_table
from hsr8.recorder.table import Table
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.suggestion import suggestion
from hsr8.version import VERSION

T = TypeVar("T")

INCOMPLETE = (RUNNING, FAILED, "interrupted", "error")  # exit reasons of runs without all records


@dataclass(frozen=True)
class Run:
    """A run folder.

        run = open_run("runs/course")
        run.records["zmp"]  # planned ZMP (n, 2)
        run.unit("records.zmp")  # "m"

    Attributes:
        path: the folder.
        manifest: versions, seed, exit reason.
    """

    path: Path
    manifest: dict[str, Any]

    @property
    def seed(self) -> int:
        """Seed of the run."""
        return int(self.manifest["seed"])

    @property
    def ended(self) -> bool:
        """Whether the run ended by itself, so that its records are complete."""
        return self.manifest.get("exit_reason") not in INCOMPLETE

    @property
    def running(self) -> bool:
        """Whether the run had not ended, or was killed, when its manifest was read."""
        return bool(self.manifest.get("exit_reason") == RUNNING)

    @property
    def scenario_file(self) -> Path:
        """File of the resolved scenario."""
        return self.path / run_folder.SCENARIO

    def scenario_text(self) -> str:
        """Return the resolved scenario as TOML.

        Raises:
            UsageError: it cannot be read.
        """
        try:
            return read_text(self.scenario_file)
        except OSError as error:
            raise UsageError(f"cannot read {self.scenario_file}: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise UsageError(f"cannot read {self.scenario_file}: {error}") from error

    def scenario(self) -> Scenario:
        """Return the scenario with the seed of the run.

        Raises:
            ScenarioError: this version cannot read it.
        """
        try:
            return load_scenario(str(self.scenario_file), seed=self.seed)
        except ScenarioError as error:
            made_by = (
                f"hsr8 {self.manifest.get('hsr8', '?')} of {self.manifest.get('started', '?')}"
            )
            raise ScenarioError(
                f"{error}\n  the run was made by {made_by}, this is hsr8 {VERSION}: "
                "run it again, or read it with the version that made it"
            ) from error

    @property
    def log_file(self) -> Path | None:
        """Rerun log; None after ``--no-log``."""
        file = self.path / run_folder.LOG
        return file if file.is_file() else None

    def metrics(self) -> dict[str, Any]:
        """Return the results; empty if the run did not get there."""
        file = self.path / run_folder.METRICS
        return _json(file) if os.path.lexists(file) else {}

    @cached_property
    def ticks(self) -> Table:
        """Sensors and setpoints of every control tick.

        Raises:
            UsageError: here and for the other tables, the file is damaged or, in a run that ended,
                cut off.
        """
        return self._table("ticks")

    @cached_property
    def records(self) -> Table:
        """True state of the world and state of the walking engine, every 20 ms."""
        return self._table("records")

    @cached_property
    def frames(self) -> Table:
        """Detections, belief and decisions of every camera frame."""
        return self._table("frames")

    @cached_property
    def seconds(self) -> Table:
        """Hashes and saturation, every second."""
        return self._table("seconds")

    @cached_property
    def events(self) -> Table:
        """Events."""
        return self._table("events")

    @cached_property
    def images(self) -> Table:
        """Images of the head camera."""
        return self._table("images")

    def unit(self, column: str) -> str:
        """Return the unit of a column, for example of ``records.zmp``.

        Raises:
            UsageError: unknown table or column.
        """
        table, _, name = column.partition(".")
        if table not in TABLES:
            raise UsageError(f"unknown table {table!r}{suggestion(table, list(TABLES))}")
        unit: str = getattr(self, table).unit(name)
        return unit

    def to_pandas(self) -> dict[str, Any]:
        """Return all tables as pandas data frames by name; pandas must be installed."""
        return {name: getattr(self, name).to_pandas() for name in TABLES}

    def _table(self, name: str) -> Table:
        path = self.path / f"{name}{SUFFIX}"
        table = read_table(path, TABLES[name], whole=self.ended)
        expected = self.manifest.get("rows", {}).get(name, int(name == "ticks"))
        if self.ended and len(table) < expected:
            raise UsageError(f"{path}: cut off, it holds {len(table)} of {expected} rows")
        return table


def open_run(path: str | Path) -> Run:
    """Return the run at `path`, or the newest one in this folder, see `run_folders`.

    Raises:
        UsageError: there is no run, or its manifest cannot be read.
    """
    path = Path(path)
    try:
        if not path.exists():
            raise UsageError(f"{path}: no such run folder{_alternatives(path)}")
        if not path.is_dir():
            raise UsageError(f"{path}: a file; expected the run folder, here {path.parent}")
        runs = run_folders(path)
    except OSError as error:
        raise UsageError(f"cannot read the run folder {path}: {error.strerror}") from error
    if not runs:
        raise UsageError(
            f"{path}: no run in this folder; a run folder has a {run_folder.MANIFEST}, and "
            "`hsr8 run SCENARIO` makes one"
        )
    return _run(runs[-1])


def run_folders(path: Path) -> list[Path]:
    """Return `path` if it is a run folder, else the run folders below it, the newest last.

    Only the two levels that ``hsr8 run --out`` makes are searched: scenario and run.

    Raises:
        OSError: `path` cannot be read.
    """
    if (path / run_folder.MANIFEST).is_file():
        return [path]
    times = {}
    for folder in _subfolders(path):
        with suppress(OSError):  # such as a folder of another user
            for candidate in (folder, *_subfolders(folder)):
                manifest = candidate / run_folder.MANIFEST
                if manifest.is_file():
                    times[candidate] = manifest.stat().st_mtime_ns
    return sorted(times, key=times.__getitem__)


def _subfolders(path: Path) -> list[Path]:
    """Return the folders in a folder, without drafts, whose names begin with a dot."""
    with os.scandir(path) as entries:
        names = [e.name for e in entries if e.is_dir() and not e.name.startswith(".")]
    return [path / name for name in sorted(names)]


def _run(path: Path) -> Run:
    file = path / run_folder.MANIFEST
    manifest = _json(file)
    seed, number = manifest.get("seed"), manifest.get("format", 1)
    if not isinstance(seed, int):
        raise UsageError(f"cannot read {file}: seed: expected an integer, got {seed!r}")
    if not isinstance(number, int):
        raise UsageError(f"cannot read {file}: format: expected an integer, got {number!r}")
    check_number(number, FORMAT, path, "run folder")
    return Run(path, manifest)


def _alternatives(path: Path) -> str:
    for folder in (Path("runs"), Path("sweeps")):
        if (folder / path).is_dir():
            return f"; did you mean {folder / path}?"
    parent = path.parent
    names = sorted(p.name for p in parent.iterdir() if p.is_dir()) if parent.is_dir() else []
    if not names:
        return "; `hsr8 run SCENARIO` makes one"
    return f"; {parent} holds {', '.join(names[-8:])}"


def _json(path: Path) -> dict[str, Any]:
    try:
        value = json.loads(read_text(path))
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise UsageError(f"cannot read {path}: {error}") from error
    if not isinstance(value, dict):
        raise UsageError(f"cannot read {path}: expected a JSON object")
    return value
