"""Runs: tables, scenario and results, in a folder or in memory, also of runs that were killed."""

import json
import os
from contextlib import nullcontext, suppress
from functools import cached_property
from pathlib import Path
from typing import Any

from hsr8.errors import ScenarioError, UsageError
from hsr8.files.text import read_text
from hsr8.recording import run_folder
from hsr8.recording.manifest import FAILED, FORMAT, RUNNING
from hsr8.recording.rows import TABLES
from hsr8.recording.run_folder import Memory
from hsr8.recording.stream import SUFFIX, read_table
from hsr8.recording.table import Table
from hsr8.recording.verdict import ENDED_BY_OTHERS, Criterion, evaluate_criteria
from hsr8.scenario.loader import dump, load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.suggestion import suggestion
from hsr8.version import VERSION

INCOMPLETE = (RUNNING, FAILED, "interrupted", "error")  # exit reasons of runs without all records


class Run:
    """A run.

        run = open_run("runs/course")
        run.metrics["time_to_goal_s"]
        run.records["zmp"]  # planned ZMP (n, 2)
        run.unit("records.zmp")  # "m"

    Args:
        path: folder of the run; None in memory.
        manifest: versions, seed, exit reason.
        trust: whether the plugins that the scenario in the folder names may run.
        memory: contents of a run in memory.
    """

    def __init__(
        self,
        path: Path | None,
        manifest: dict[str, Any],
        *,
        trust: bool = False,
        memory: Memory | None = None,
    ) -> None:
        self.path = path
        self.manifest = manifest
        self._trust = trust
        self._memory = memory

    @property
    def folder(self) -> Path:
        """Folder of the run.

        Raises:
            UsageError: the run is in memory.
        """
        if self.path is None:
            raise UsageError("run: in memory, got no folder; expected hsr8.run(..., out=DIR)")
        return self.path

    @property
    def seed(self) -> int:
        """Seed of the run."""
        return int(self.manifest["seed"])

    @property
    def exit_reason(self) -> str:
        """goal, timeout, completed, fall, diverged, interrupted, running, failed or error."""
        return str(self.manifest.get("exit_reason"))

    @property
    def ended(self) -> bool:
        """Whether the run ended by itself, so that its records are complete."""
        return self.exit_reason not in INCOMPLETE

    @property
    def running(self) -> bool:
        """Whether the run had not ended, or was killed, when its manifest was read."""
        return self.exit_reason == RUNNING

    @property
    def arithmetic(self) -> str:
        """Arithmetic of NumPy: ``x86-64-v3``, the same on all processors, or ``native``."""
        return str(self.manifest.get("libraries", {}).get("arithmetic"))

    @property
    def diverged(self) -> str:
        """Message of the divergence; empty if the physics did not diverge."""
        events = self.events
        texts = events["text"][events["kind"] == "diverged"]
        return str(texts[-1]) if len(texts) else ""

    @cached_property
    def metrics(self) -> dict[str, Any]:
        """Every result by name, as in ``metrics.json``; empty if the run did not get there.

        Raises:
            UsageError: they cannot be read.
        """
        if self._memory is not None:
            return self._memory.metrics
        file = self.folder / run_folder.METRICS
        return read_json(file) if os.path.lexists(file) else {}

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """The criteria of the scenario, evaluated; empty without results.

        Raises:
            ScenarioError: this version cannot read the scenario.
        """
        if not self.metrics:
            return ()
        return evaluate_criteria(self.scenario().criteria, self.metrics)

    @property
    def criteria_met(self) -> bool:
        """Whether the run ended by itself and met every criterion of its scenario.

        Raises:
            ScenarioError: this version cannot read the scenario.
        """
        ended = bool(self.metrics) and self.exit_reason not in ENDED_BY_OTHERS
        return ended and all(criterion.met for criterion in self.criteria)

    @property
    def scenario_file(self) -> Path:
        """File of the resolved scenario."""
        return self.folder / run_folder.SCENARIO

    def scenario_text(self) -> str:
        """Return the resolved scenario as TOML.

        Raises:
            UsageError: it cannot be read.
        """
        if self._memory is not None:
            return dump(self._memory.scenario)
        try:
            return read_text(self.scenario_file)
        except OSError as error:
            raise UsageError(f"cannot read {self.scenario_file}: {error.strerror}") from error

    def scenario(self) -> Scenario:
        """Return the scenario with the seed of the run.

        Raises:
            ScenarioError: this version cannot read it.
        """
        if self._memory is not None:
            return self._memory.scenario
        try:
            return load_scenario(str(self.scenario_file), seed=self.seed, trust=self._trust)
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
        """Rerun log of the whole run; None without one, or if it was made during the run."""
        file, manifest = self.folder / run_folder.LOG, self.folder / run_folder.MANIFEST
        whole = file.is_file() and file.stat().st_mtime_ns >= manifest.stat().st_mtime_ns
        return file if whole and not self.running else None

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

    @cached_property
    def commands(self) -> Table:
        """Commands from outside, of a driven run."""
        return self._table("commands")

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
        if self._memory is not None:
            return read_table(name, self._memory.tables.get(name), TABLES[name])
        path = self.folder / f"{name}{SUFFIX}"
        try:
            with path.open("rb") if os.path.lexists(path) else nullcontext() as file:
                table = read_table(name, file, TABLES[name])
        except OSError as error:
            raise UsageError(f"cannot read {path}: {error.strerror}") from error
        except ValueError as error:
            raise UsageError(f"{path}: not a table of a run, got {error}") from error
        expected = self.manifest.get("rows", {}).get(name, int(name == "ticks"))
        if self.ended and len(table) < expected:
            raise UsageError(
                f"{path}: cut off or damaged, got {len(table)} rows; expected {expected}"
            )
        return table


def read_json(path: Path) -> dict[str, Any]:
    """Return the JSON object in a file.

    Raises:
        UsageError: it cannot be read.
    """
    try:
        value = json.loads(read_text(path))
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise UsageError(f"cannot read {path}: {error}") from error
    if not isinstance(value, dict):
        raise UsageError(f"cannot read {path}: expected a JSON object")
    return value


def open_run(path: str | Path, *, trust: bool = False) -> Run:
    """Return the run at `path`, or the newest one in this folder, see `run_folders`.

    Args:
        path: path of a run folder, or of a folder above it.
        trust: whether the plugins that the scenario in the folder names may run.

    Raises:
        UsageError: there is no run, or its manifest cannot be read.
    """
    path = Path(path)
    try:
        if not path.exists():
            raise UsageError(f"{path}: no such run folder{_alternatives(path)}")
        if not path.is_dir():
            raise UsageError(f"{path}: a file; expected the run folder, here {path.parent}")
        folders = run_folders(path)
    except OSError as error:
        raise UsageError(f"cannot read the run folder {path}: {error.strerror}") from error
    if not folders:
        raise UsageError(
            f"{path}: no run in this folder; a run folder has a {run_folder.MANIFEST}, and "
            "`hsr8 run SCENARIO` makes one"
        )
    return _run(folders[-1], trust)


def runs(folder: str | Path, *, trust: bool = False) -> list[Run]:
    """Return the runs in a folder, see `run_folders`; those that cannot be read are left out.

    Args:
        folder: ``runs``, one of its folders, or a run folder.
        trust: whether the plugins that the scenarios in the folders name may run.

    Raises:
        UsageError: the folder cannot be read.
    """
    try:
        folders = run_folders(Path(folder))
    except FileNotFoundError:
        raise UsageError(f"{folder}: no such folder") from None
    except OSError as error:
        raise UsageError(f"{folder}: cannot be read: {error.strerror}") from error
    readable = []
    for path in folders:
        with suppress(UsageError):
            readable.append(_run(path, trust))
    return readable


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
    folders = [path / name for name in sorted(os.listdir(path)) if not name.startswith(".")]
    return [folder for folder in folders if os.path.isdir(folder)]  # a looping link is none


def _run(path: Path, trust: bool) -> Run:
    file = path / run_folder.MANIFEST
    manifest = read_json(file)
    seed, number = manifest.get("seed"), manifest.get("format", 1)
    if not isinstance(seed, int):
        raise UsageError(f"cannot read {file}: seed: expected an integer, got {seed!r}")
    if not isinstance(number, int):
        raise UsageError(f"cannot read {file}: format: expected an integer, got {number!r}")
    if number != FORMAT:
        raise UsageError(
            f"{path}: run folder of format {number}, hsr8 {VERSION} reads format {FORMAT}: "
            "run the scenario again, or use the version of hsr8 that wrote it"
        )
    rows = manifest.get("rows", {})
    if not isinstance(rows, dict) or not all(isinstance(count, int) for count in rows.values()):
        raise UsageError(f"cannot read {file}: rows: expected numbers by table, got {rows!r}")
    return Run(path, manifest, trust=trust)


def _alternatives(path: Path) -> str:
    for folder in (Path("runs"), Path("sweeps")):
        if (folder / path).is_dir():
            return f"; did you mean {folder / path}?"
    parent = path.parent
    names = sorted(p.name for p in parent.iterdir() if p.is_dir()) if parent.is_dir() else []
    if not names:
        return "; `hsr8 run SCENARIO` makes one"
    return f"; {parent} holds {', '.join(names[-8:])}"
