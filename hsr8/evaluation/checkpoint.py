"""A run folder's checkpoint: where a killed run goes on, to the identical end."""

import os
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from hsr8 import snapshot
from hsr8.errors import UsageError
from hsr8.evaluation.metrics import Metrics
from hsr8.loop import TICKS_A_SECOND, Simulation
from hsr8.recorder.files import atomic
from hsr8.recorder.files.reading import read_bytes
from hsr8.recorder.files.writing import writing
from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import versions
from hsr8.recorder.run.run_reader import Run
from hsr8.robot_builder import robot_model
from hsr8.version import VERSION

FILE = "checkpoint.bin"
KEPT = (
    run_folder.EVENTS,
    run_folder.TRAJECTORY,
    run_folder.WALKING,
    run_folder.MEASUREMENTS,
    run_folder.TAPE,
    run_folder.FRAMES,
)  # files that are cut back to where they were, and written on


class Flushable(Protocol):
    """What writes a file of the run folder."""

    def flush(self) -> None:
        """Hand everything to the operating system."""


class Checkpoints:
    """Saves a run every few simulated seconds; each takes the place of the one before.

    Args:
        metrics: the run's results so far.
        folder: its run folder.
        period: simulated time between two of them, whole seconds [s].
        writers: of the files that are kept, and of the log.
    """

    def __init__(
        self,
        metrics: Metrics,
        folder: Path,
        period: int,
        writers: Sequence[Flushable],
    ) -> None:
        self._metrics = metrics
        self._folder = folder
        self._ticks = period * TICKS_A_SECOND
        self._writers = writers

    def __call__(self, simulation: Simulation) -> None:
        """Save the run, if it is time to."""
        if simulation.tick == 0 or simulation.tick % self._ticks:
            return
        with writing(self._folder):
            self._save(simulation)

    def _save(self, simulation: Simulation) -> None:
        for writer in self._writers:
            writer.flush()
        parts = simulation.snapshot() | {
            "made_by": _made_by(),
            "scenario": (self._folder / run_folder.SCENARIO).read_bytes(),
            "metrics": self._metrics,
            "sizes": {name: (self._folder / name).stat().st_size for name in KEPT},
        }
        atomic.write_bytes(self._folder / FILE, snapshot.encode(parts))


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """A checkpoint that has been read.

    Attributes:
        parts: of the simulation.
        metrics: results so far.
        sizes: of the files of the run folder at that moment [byte].
    """

    parts: dict[str, Any]
    metrics: Metrics
    sizes: dict[str, int]

    @property
    def frame(self) -> FrameRecord | None:
        """Camera frame that was published last."""
        frame = self.parts.get("_published")
        return frame if isinstance(frame, FrameRecord) else None

    def cut_back(self, run: Run) -> None:
        """Forget what `run` wrote after the checkpoint.

        Raises:
            UsageError: a file is shorter than it was, damaged before, or may not be written;
                none has been changed then.
        """
        for name, size in self.sizes.items():
            file = run.path / name
            found = file.stat().st_size if file.exists() else 0
            if found < size:
                raise UsageError(
                    f"{file} is shorter than at the checkpoint: {found} < {size} bytes"
                )
        run.require_lines(self.sizes)
        if not os.access(run.path, os.W_OK):
            raise UsageError(f"cannot write the run folder {run.path}: it may only be read")
        try:
            with ExitStack() as stack:  # all can be written before any is
                paths = [run.path / name for name in self.sizes]
                files = [stack.enter_context(path.open("ab")) for path in paths]
                for kept, size in zip(files, self.sizes.values(), strict=True):
                    kept.truncate(size)
        except OSError as error:
            raise UsageError(
                f"cannot write {error.filename or run.path}: {error.strerror}"
            ) from None


def read_checkpoint(run: Run, simulation: Simulation) -> Checkpoint:
    """The checkpoint of `run`, for a fresh `simulation` of its scenario.

    Raises:
        UsageError: there is none, or it is damaged, of another version or another scenario.
    """
    file = run.path / FILE
    try:
        content = read_bytes(file, snapshot.LARGEST + 1024)
    except FileNotFoundError:
        raise UsageError(
            f"{run.path} has no checkpoint to go on from: it was run without --checkpoint, or "
            "ended before the first"
        ) from None
    except OSError as error:
        raise UsageError(f"cannot read {file}: {error.strerror}") from error
    anchors = {"model": simulation.model, "robot model": robot_model()}
    parts = snapshot.decode(content, anchors, str(file))
    then, now = parts.get("made_by"), _made_by()
    if then != now:
        known = then if isinstance(then, dict) else {}
        differ = [f"{n} was {known.get(n)}, is {now[n]}" for n in now if known.get(n) != now[n]]
        raise UsageError(f"{file} is of other versions: {'; '.join(differ)}; run it again")
    if parts.get("scenario") != run.scenario_bytes():
        raise UsageError(f"{run.scenario_file} is another one than at the checkpoint")
    metrics, sizes = parts.get("metrics"), parts.get("sizes")
    if not isinstance(metrics, Metrics) or not isinstance(sizes, dict) or set(sizes) != set(KEPT):
        raise UsageError(f"{file} holds no whole checkpoint")
    return Checkpoint(parts, metrics, sizes)


def _made_by() -> dict[str, str]:
    """What must be the same for bits to be the same."""
    return {"hsr8": VERSION, **versions()}
