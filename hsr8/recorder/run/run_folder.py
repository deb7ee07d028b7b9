"""The folder of a run: ``runs/<scenario>/<seed>-<id>/``.

    scenario.toml    scenario, fully resolved
    manifest.json    versions, seed, renderer, exit reason
    metrics.json     results, at the end
    events.jsonl     events, one per line
    trajectory.bin   motion of robot and movers
    walking.bin      walking: ZMP, feet, torques, velocities
    frames.jsonl     belief and decisions, one camera frame per line
    log.rrd          log for the Rerun viewer
    video.mp4        after ``hsr8 render``
    crash.txt        traceback of an internal error

Events are written immediately and records once a second, so the folder of a killed run is
complete up to its last second.
"""

import errno
import secrets
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.record import TickRecord
from hsr8.recorder.files import atomic
from hsr8.recorder.files.writing import NO_ROOM, GrowingFile, failure, writing
from hsr8.recorder.record_buffer import RecordBuffer
from hsr8.recorder.run import frame_summary
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.trajectory import TrajectoryWriter

Array = NDArray[np.float64]

SCENARIO = "scenario.toml"
MANIFEST = "manifest.json"
METRICS = "metrics.json"
EVENTS = "events.jsonl"
TRAJECTORY = "trajectory.bin"
WALKING = "walking.bin"
FRAMES = "frames.jsonl"
LOG = "log.rrd"
VIDEO = "video.mp4"
CRASH = "crash.txt"


class RunFolder:
    """Writer of the folder of one run.

    Args:
        path: new folder, see `create`.
        manifest: of the run; written immediately.
        scenario: the resolved scenario as TOML.
        movers: number of movers, which are the last of the obstacles.

    Raises:
        RecordingFailed: here and in every method, the folder cannot be written.
    """

    def __init__(self, path: Path, manifest: Manifest, scenario: str, movers: int) -> None:
        self.path = path
        self._manifest = manifest
        self._n_movers = movers
        self._trajectory: TrajectoryWriter | None = None
        self._gaze_map: Array | None = None  # the latest written one; many frames share a map
        self._buffer = RecordBuffer()
        with writing(path):
            manifest.write(path / MANIFEST)
            atomic.write_text(path / SCENARIO, scenario)
        self._events = GrowingFile(path / EVENTS)
        self.rows: Callable[[], Mapping[str, int]] = dict
        self._frames = GrowingFile(path / FRAMES)

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

    def on_record(self, record: TickRecord) -> None:
        """Append the motion and, if there is one, the camera frame."""
        if self._trajectory is None:
            file = self.path / TRAJECTORY
            self._trajectory = TrajectoryWriter(file, len(record.truth.qpos), self._n_movers)
        if not self._buffer.add(record):
            return
        with writing(self.path):
            if not (self.path / MANIFEST).exists():  # open files outlive their folder
                raise FileNotFoundError(errno.ENOENT, "the folder was removed")
        self._write_buffer()
        for writer in (self._trajectory, self._frames):
            writer.flush()

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Write one line."""
        line = atomic.dumps({"time": round(time, 4), "kind": kind, "text": text})
        self._events.write(f"{line}\n".encode())
        self._events.flush()

    def close(self, exit_reason: str) -> None:
        """Write the remaining records and the exit reason; close every file."""
        with ExitStack() as stack:
            stack.callback(self.note, exit_reason)
            for file in (self._events, self._frames, self._trajectory):
                if file is not None:
                    stack.callback(file.close)
            stack.callback(self._write_buffer)

    def note(self, exit_reason: str) -> None:
        """Write the exit reason into the manifest."""
        with writing(self.path):
            self._manifest.ended(exit_reason, self.rows()).write(self.path / MANIFEST)

    def _write_buffer(self) -> None:
        records = self._buffer.take()
        if self._trajectory is not None and records:
            truths = [record.truth for record in records]
            first = len(truths[0].obstacle_positions) - self._n_movers
            self._trajectory.extend(
                [record.time for record in records],
                [truth.qpos for truth in truths],
                [truth.obstacle_positions[first:] for truth in truths],
            )
        frames = [(record.frame, record.truth) for record in records if record.frame is not None]
        for frame, truth in frames:
            gaze_map = frame.gaze.gaze_map
            new = gaze_map is not self._gaze_map
            self._frames.write(f"{frame_summary.to_line(frame, truth, new_map=new)}\n".encode())
            self._gaze_map = gaze_map


def write_metrics(path: Path, metrics: Mapping[str, Any]) -> None:
    """Write the results into the run folder `path`.

    Raises:
        RecordingFailed: they cannot be written.
    """
    with writing(path):
        atomic.write_json(path / METRICS, metrics)
