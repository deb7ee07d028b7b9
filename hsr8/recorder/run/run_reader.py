"""Reading a run folder back, also that of a run that was killed."""

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ScenarioError, UsageError
from hsr8.file_format import check_number
from hsr8.recorder.files.json_lines import read_lines
from hsr8.recorder.files.reading import LARGEST_JSON, read_bytes
from hsr8.recorder.files.writing import FAILED
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.frame_summary import FrameSummary, from_line
from hsr8.recorder.run.manifest import FORMAT, RUNNING
from hsr8.recorder.run.trajectory import Trajectory, read_trajectory
from hsr8.recorder.run.walking_table import WalkingTable, read_walking_table
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.version import VERSION

T = TypeVar("T")

CUT_SHORT = (RUNNING, FAILED, "interrupted", "error")  # ends after which records may lack theirs


@dataclass(frozen=True, slots=True)
class Run:
    """A run folder.

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
        """Whether the run came to its end, so that its records are whole."""
        return self.manifest.get("exit_reason") not in CUT_SHORT

    @property
    def scenario_file(self) -> Path:
        """The resolved scenario."""
        return self.path / run_folder.SCENARIO

    def scenario_bytes(self) -> bytes:
        """The resolved scenario as it stands in the folder.

        Raises:
            UsageError: it cannot be read.
        """
        try:
            return read_bytes(self.scenario_file)
        except OSError as error:
            raise UsageError(f"cannot read {self.scenario_file}: {error.strerror}") from error

    def scenario(self) -> Scenario:
        """What was run, with the seed of the run.

        Raises:
            ScenarioError: this version does not understand it.
        """
        try:
            return load_scenario(str(self.scenario_file), seed=self.seed)
        except ScenarioError as error:
            made_by = (
                f"hsr8 {self.manifest.get('hsr8', '?')} of {self.manifest.get('started', '?')}"
            )
            raise ScenarioError(
                f"{error}\n  the run was made by {made_by}, this is hsr8 {VERSION}: "
                "run it again, or read it with the version it was made by"
            ) from error

    @property
    def log_files(self) -> list[Path]:
        """The Rerun log; a run with ``--no-log`` has none, one that was resumed several."""
        return run_folder.logs(self.path)

    def metrics(self) -> dict[str, Any]:
        """Results; empty if the run did not get there."""
        file = self.path / run_folder.METRICS
        return _json(file) if file.exists() else {}

    def trajectory(self) -> Trajectory:
        """Motion of robot and movers.

        Raises:
            UsageError: there is none, or it is cut off though the run ended.
        """
        trajectory = read_trajectory(self.path / run_folder.TRAJECTORY)
        self._must_reach_the_end(run_folder.TRAJECTORY, trajectory.time)
        return trajectory

    def walking(self) -> WalkingTable:
        """How the robot walked.

        Raises:
            UsageError: there is no table, or it is cut off though the run ended.
        """
        table = read_walking_table(self.path / run_folder.WALKING)
        self._must_reach_the_end(run_folder.WALKING, table.time)
        return table

    def frames(self) -> tuple[FrameSummary, ...]:
        """Belief and decisions at every camera frame; empty if there were none.

        Raises:
            UsageError: a line is damaged, or they are cut off though the run ended.
        """
        frames = self._frames()
        if frames:
            self.must_hold(run_folder.FRAMES, len(frames), "camera_frames", "frames")
        return frames

    def events(self) -> tuple[dict[str, Any], ...]:
        """What happened, each with ``time``, ``kind`` and ``text``.

        Raises:
            UsageError: a line is damaged, or the last one cut off though the run ended.
        """
        return self._events()

    def require_lines(self, sizes: Mapping[str, int]) -> None:
        """Refuse a run whose frames or events are damaged.

        Args:
            sizes: how much of each file must be whole, by its name [byte].

        Raises:
            UsageError: they are.
        """
        self._frames(sizes[run_folder.FRAMES])
        self._events(sizes[run_folder.EVENTS])

    def _frames(self, size: int | None = None) -> tuple[FrameSummary, ...]:
        frames: list[FrameSummary] = []

        def parse(line: str) -> FrameSummary:
            return from_line(line, frames[-1] if frames else None)

        for frame in self._lines(run_folder.FRAMES, parse, size):
            frames.append(frame)  # `parse` needs it there at once
        return tuple(frames)

    def _events(self, size: int | None = None) -> tuple[dict[str, Any], ...]:
        return tuple(self._lines(run_folder.EVENTS, _event, size))

    def _lines(self, name: str, parse: Callable[[str], T], size: int | None) -> Iterator[T]:
        file, whole = self.path / name, self.ended or size is not None
        return read_lines(file, parse, whole=whole, size=size) if file.exists() else iter(())

    def must_hold(self, name: str, found: float, result: str, unit: str) -> None:
        """Refuse a record of a run that ended which holds less than the run's results tell.

        Args:
            name: of the record's file.
            found: what it holds [unit].
            result: name of the result that tells what there was [unit].
            unit: of both.

        Raises:
            UsageError: it does.
        """
        told = self.metrics().get(result) if self.ended else None
        if isinstance(told, int | float) and found < told:
            held = f"it holds {found:g} of {told:g} {unit}"
            raise UsageError(f"{self.path / name} is cut off: {held}")

    def _must_reach_the_end(self, name: str, time: NDArray[np.float64]) -> None:
        self.must_hold(name, float(time[-1]) if len(time) else 0.0, "sim_time_s", "s")


def open_run(path: str | Path) -> Run:
    """The run at `path`, or the newest run below it.

    Raises:
        UsageError: there is no run there.
    """
    path = Path(path)
    try:
        if (path / run_folder.MANIFEST).is_file():
            return _run(path)
        if not path.exists():
            raise UsageError(f"there is no run folder {path}{_known(path)}")
        if path.is_file():
            raise UsageError(f"{path} is a file: give the run folder it lies in, {path.parent}")
        files = [file for file in path.glob(f"**/{run_folder.MANIFEST}") if file.is_file()]
        runs = sorted(files, key=lambda file: file.stat().st_mtime_ns)
    except OSError as error:
        raise UsageError(f"cannot read the run folder {path}: {error.strerror}") from error
    if not runs:
        raise UsageError(
            f"{path} holds no run: a run folder has a {run_folder.MANIFEST}; "
            "`hsr8 run SCENARIO` makes one"
        )
    return _run(runs[-1].parent)


def _run(path: Path) -> Run:
    _must_hold_files_alone(path)
    file = path / run_folder.MANIFEST
    manifest = _json(file)
    if not isinstance(manifest.get("seed"), int):
        raise UsageError(f"cannot read {file}: it names no seed")
    number = manifest.get("format", 1)
    if not isinstance(number, int):
        raise UsageError(f"cannot read {file}: its format is no number")
    check_number(number, FORMAT, path, "run folder")
    return Run(path, manifest)


def _must_hold_files_alone(path: Path) -> None:
    """What is read, written or packed lies in the folder, not where a link in it points to."""
    try:
        found = sorted(path.iterdir())
        links = [file for file in found if file.is_symlink()]
        others = [file for file in found if not (file.is_file() or file.is_dir())]
    except OSError as error:
        raise UsageError(f"cannot read the run folder {path}: {error.strerror}") from error
    for file in links:
        raise UsageError(f"{file} is a link; a run folder holds files alone")
    for file in others:
        raise UsageError(f"{file} is no file; a run folder holds files alone")


def _event(line: str) -> dict[str, Any]:
    event = json.loads(line)
    return {"time": float(event["time"]), "kind": str(event["kind"]), "text": str(event["text"])}


def _known(path: Path) -> str:
    """Where the run may be instead, or how to make one."""
    for folder in (Path("runs"), Path("sweeps")):
        if (folder / path).is_dir():
            return f"; did you mean {folder / path}?"
    parent = path.parent
    names = sorted(p.name for p in parent.iterdir() if p.is_dir()) if parent.is_dir() else []
    held = f"{parent} holds {', '.join(names[-8:])}" if names else "`hsr8 run SCENARIO` makes one"
    return f"; {held}"


def _json(path: Path) -> dict[str, Any]:
    try:
        value = json.loads(read_bytes(path, LARGEST_JSON).decode("utf-8"))
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise UsageError(f"cannot read {path}: {error}") from error
    if not isinstance(value, dict):
        raise UsageError(f"cannot read {path}: it is no JSON object")
    return value
