"""Reading of run folders, also of runs that were killed."""

import os
from contextlib import suppress
from pathlib import Path

from hsr8.errors import UsageError
from hsr8.recording import run_folder
from hsr8.recording.manifest import FORMAT
from hsr8.recording.run import Run, read_json
from hsr8.version import VERSION


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
