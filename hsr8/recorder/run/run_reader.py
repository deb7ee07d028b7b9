"""Reading of run folders, also of runs that were killed."""

import json
import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hsr8.errors import ScenarioError, UsageError
from hsr8.files.text import read_text
from hsr8.recorder.rows import TABLES
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import FORMAT
from hsr8.recorder.run.run import Run
from hsr8.recorder.stream import SUFFIX, read_table
from hsr8.recorder.table import Table
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.version import VERSION


@dataclass(frozen=True)
class StoredRun(Run):
    """A run in a folder.

    Attributes:
        path: the folder.
        trust: whether the plugins that its scenario names may run.
    """

    path: Path
    trust: bool = False

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

    def scenario(self) -> Scenario:
        """Return the scenario with the seed of the run.

        Raises:
            ScenarioError: this version cannot read it.
        """
        try:
            return load_scenario(str(self.scenario_file), seed=self.seed, trust=self.trust)
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
        file, manifest = self.path / run_folder.LOG, self.path / run_folder.MANIFEST
        whole = file.is_file() and file.stat().st_mtime_ns >= manifest.stat().st_mtime_ns
        return file if whole and not self.running else None

    def metrics(self) -> dict[str, Any]:
        """Return the results; empty if the run did not get there."""
        file = self.path / run_folder.METRICS
        return _json(file) if os.path.lexists(file) else {}

    def _table(self, name: str) -> Table:
        path = self.path / f"{name}{SUFFIX}"
        table = read_table(path, TABLES[name])
        expected = self.manifest.get("rows", {}).get(name, int(name == "ticks"))
        if self.ended and len(table) < expected:
            raise UsageError(
                f"{path}: cut off or damaged, got {len(table)} rows; expected {expected}"
            )
        return table


def open_run(path: str | Path, *, trust: bool = False) -> StoredRun:
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


def runs(folder: str | Path, *, trust: bool = False) -> list[StoredRun]:
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


def _run(path: Path, trust: bool) -> StoredRun:
    file = path / run_folder.MANIFEST
    manifest = _json(file)
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
    return StoredRun(path, manifest, trust)


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
