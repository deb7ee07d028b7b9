"""The folder a run leaves behind: ``runs/<scenario>/<seed>-<id>/``.

    scenario.toml    what was run, fully resolved
    manifest.json    versions, seed, renderer, exit reason
    metrics.json     results, at the end
    events.jsonl     what happened, one line each
    trajectory.bin   motion of robot and movers
    walking.bin      how it walked: ZMP, feet, torques, velocities
    measurements.bin all that reached the belief and the decisions, exactly
    tape.bin         what the servos were told in every tick, a hash of the world each second
    frames.jsonl     belief and decisions, one camera frame a line
    log.rrd          everything, for the Rerun viewer
    video.mp4        after ``hsr8 render``
    checkpoint.bin   where the run can go on, with ``--checkpoint``
    crash.txt        traceback of an internal error, if there was one

Events are written as they happen and records in blocks, so a killed run leaves a folder that can
be read up to its last second.
"""

import errno
import re
import secrets
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.files import atomic
from hsr8.recorder.files.writing import NO_ROOM, failure, writing
from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.record import TickRecord
from hsr8.recorder.record_buffer import RecordBuffer
from hsr8.recorder.run import frame_summary
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.measurements import MeasurementWriter
from hsr8.recorder.run.trajectory import TrajectoryWriter

Array = NDArray[np.float64]

SCENARIO = "scenario.toml"
MANIFEST = "manifest.json"
METRICS = "metrics.json"
EVENTS = "events.jsonl"
TRAJECTORY = "trajectory.bin"
WALKING = "walking.bin"
MEASUREMENTS = "measurements.bin"
TAPE = "tape.bin"
FRAMES = "frames.jsonl"
LOG = "log.rrd"
VIDEO = "video.mp4"
CRASH = "crash.txt"

_LOG_OF_PART = re.compile(r"log(?:-(\d{1,9}))?\.rrd")


class RunFolder:
    """Listener that writes the folder of one run.

    Args:
        path: new folder, see `create`, or that of a run that goes on.
        manifest: of the run; written at once.
        scenario: the resolved scenario as TOML.
        movers: number of movers; they are the last of the obstacles.
        before: camera frame told last, of a run that goes on.

    Raises:
        RecordingFailed: here and in every method, the folder cannot be written.
    """

    def __init__(
        self,
        path: Path,
        manifest: Manifest,
        scenario: str,
        movers: int,
        before: FrameRecord | None = None,
    ) -> None:
        self.path = path
        self._manifest = manifest
        self._n_movers = movers
        self._trajectory: TrajectoryWriter | None = None
        # Told last; a gaze rests for many frames.
        self._gaze_map: Array | None = None if before is None else before.gaze.gaze_map
        self._waiting = RecordBuffer()
        with writing(path):
            manifest.write(path / MANIFEST)
            atomic.write_text(path / SCENARIO, scenario)
            self._events: TextIO = (path / EVENTS).open("a", encoding="utf-8", buffering=1)
            self._measurements = MeasurementWriter(path / MEASUREMENTS)
            self._frames: TextIO = (path / FRAMES).open("a", encoding="utf-8")

    @staticmethod
    def create(out: Path, scenario: str, seed: int) -> Path:
        """Make a new folder under `out`; it never overwrites one.

        Raises:
            RecordingFailed: the disk is full or may not be written.
            UsageError: the folder cannot be made for another reason.
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
                (path / EVENTS).touch()
                return path
        except OSError as error:
            if error.errno in NO_ROOM:
                reason = f"{error.strerror}; choose another with --out"
                raise failure(parent, reason) from error
            raise UsageError(
                f"cannot write the run folder {parent}: {error.strerror}; choose another with --out"
            ) from error

    def on_record(self, record: TickRecord) -> None:
        """Append the motion and, if there is one, the camera frame."""
        if self._trajectory is None:
            file = self.path / TRAJECTORY
            self._trajectory = TrajectoryWriter(file, len(record.truth.qpos), self._n_movers)
        if self._waiting.add(record):
            self.flush()

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Write one line."""
        line = atomic.dumps({"time": round(time, 4), "kind": kind, "text": text})
        with writing(self.path):
            self._events.write(f"{line}\n")

    def flush(self) -> None:
        """Hand everything to the operating system."""
        with writing(self.path):
            if not (self.path / MANIFEST).exists():  # open files outlive their folder
                raise FileNotFoundError(errno.ENOENT, "it is no longer there")
            self._write_pending()
            if self._trajectory is not None:
                self._trajectory.flush()
            self._frames.flush()
            self._measurements.flush()

    def close(self, exit_reason: str) -> None:
        """Finish the files and note how the run ended; each, also when another one fails."""
        with writing(self.path), ExitStack() as farewell:
            farewell.callback(self.note, exit_reason)
            farewell.callback(self._events.close)
            farewell.callback(self._measurements.close)
            farewell.callback(self._frames.close)
            if self._trajectory is not None:
                farewell.callback(self._trajectory.close)
            farewell.callback(self._write_pending)

    def note(self, exit_reason: str) -> None:
        """Note how the run ended."""
        with writing(self.path):
            self._manifest.ended(exit_reason).write(self.path / MANIFEST)

    def _write_pending(self) -> None:
        """Write the records that wait."""
        records = self._waiting.take()
        if self._trajectory is not None and records:
            truths = [record.truth for record in records]
            first = len(truths[0].obstacle_positions) - self._n_movers
            self._trajectory.extend(
                [record.time for record in records],
                [truth.qpos for truth in truths],
                [truth.obstacle_positions[first:] for truth in truths],
            )
        seen = [(record.frame, record.truth) for record in records if record.frame is not None]
        for frame, _ in seen:
            self._measurements.add(frame)
        for frame, truth in seen:
            gaze_map = frame.gaze.gaze_map
            new = gaze_map is not self._gaze_map
            self._frames.write(frame_summary.to_line(frame, truth, new_map=new) + "\n")
            self._gaze_map = gaze_map


def write_metrics(path: Path, metrics: Mapping[str, Any]) -> None:
    """Write the results into the run folder `path`.

    Raises:
        RecordingFailed: they cannot be written.
    """
    with writing(path):
        atomic.write_json(path / METRICS, metrics)


def logs(path: Path) -> list[Path]:
    """Rerun logs in the run folder `path`; a run that was resumed has one for each part."""
    return [file for _, file in sorted(_parts(path).items())]


def next_log(path: Path) -> Path:
    """Log of the part of the run in `path` that begins now."""
    part = max(_parts(path), default=0) + 1
    first = path / LOG
    return first if part == 1 else first.with_stem(f"{first.stem}-{part}")


def _parts(path: Path) -> dict[int, Path]:
    """Logs in the run folder `path`, by the part of the run, counted from 1."""
    found = {file: _LOG_OF_PART.fullmatch(file.name) for file in path.glob("log*.rrd")}
    return {int(match[1] or 1): file for file, match in found.items() if match is not None}
