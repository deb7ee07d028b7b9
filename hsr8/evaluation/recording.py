"""A simulation whose results are measured, and which leaves a run folder behind."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hsr8.errors import RecordingFailed, SimulationDiverged
from hsr8.evaluation.checkpoint import Checkpoint, Checkpoints, Flushable, read_checkpoint
from hsr8.evaluation.metrics import Metrics
from hsr8.evaluation.verdict import Check, judge
from hsr8.gl import require_gl
from hsr8.loop import Simulation
from hsr8.plugin_file import digests
from hsr8.recorder.files.writing import FAILED
from hsr8.recorder.log.threads import require_threads
from hsr8.recorder.log_level import LogLevel
from hsr8.recorder.record import Listener
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.recorder.run.run_reader import Run
from hsr8.recorder.run.tape import TapeWriter
from hsr8.recorder.run.walking_table import WalkingTableWriter
from hsr8.scenario.loader import dump
from hsr8.scenario.schema import Scenario

LONGEST_INDEXED = 600.0  # logs of longer runs have no index, which would fill the memory [s]


@dataclass(frozen=True, slots=True)
class Result:
    """What came of a run.

    Attributes:
        metrics: every result by name, as in ``metrics.json``.
        checks: the scenario's criteria against them.
        folder: the run folder, None where nothing was written.
        diverged: what blew up; empty in a run that came to its end.
    """

    metrics: dict[str, Any]
    checks: tuple[Check, ...]
    folder: Path | None = None
    diverged: str = ""

    @property
    def exit_reason(self) -> str:
        """goal, timeout, completed, fall, diverged or interrupted."""
        return str(self.metrics["exit_reason"])

    @property
    def passed(self) -> bool:
        """Whether it came to its end and met every criterion."""
        return self.exit_reason not in ("diverged", "interrupted") and all(
            check.passed for check in self.checks
        )


def renderer_of(scenario: Scenario) -> str:
    """Name of what draws the head camera's images.

    Raises:
        RenderingUnavailable: nothing does.
    """
    return require_gl() if scenario.camera.source == "rendered" else scenario.camera.source


class Recording:
    """A simulation that is measured and, if it has a folder, recorded.

    Args:
        simulation: not yet begun.
        listeners: told of everything beside the records' writers.
    """

    def __init__(self, simulation: Simulation, listeners: Sequence[Listener] = ()) -> None:
        mission = simulation.scenario.navigation.mission
        self._simulation = simulation
        self._listeners = list(listeners)
        self._metrics = Metrics(simulation.layout, mission.r_via, mission.r_goal)
        self._folder: RunFolder | None = None
        self._checkpoint: Checkpoint | None = None

    def into(
        self,
        path: Path,
        manifest: Manifest,
        *,
        log: LogLevel | None = LogLevel.STANDARD,
        live: str = "",
        checkpoint: int = 0,
    ) -> None:
        """Record into a folder.

        Args:
            path: of the run; new, or that of a run that goes on.
            manifest: of the run.
            log: how much the Rerun log holds; None for no log.
            live: address of a viewer that is shown the log as it is written; empty for none.
            checkpoint: simulated time between two checkpoints, 0 for none [s].

        Raises:
            RecordingFailed: the folder cannot be written.
        """
        simulation, scenario = self._simulation, self._simulation.scenario
        before = None if self._checkpoint is None else self._checkpoint.frame
        movers = len(simulation.layout.movers)
        libraries = manifest.libraries | digests(scenario.plugin)
        manifest = replace(manifest, libraries=libraries, log=log or "", checkpoint=checkpoint)
        folder = RunFolder(path, manifest, dump(scenario), movers, before)
        self._folder = folder
        with self._failure_noted():
            table = WalkingTableWriter(
                path / run_folder.WALKING, simulation.model, simulation.index
            )
            tape = TapeWriter(path / run_folder.TAPE)
            simulation.tape = tape
            writers: list[Listener] = [folder, table]
            saved: list[Flushable] = [folder, table, tape]
            if log is not None:
                require_threads(path)
                # Loaded where it is needed: runs without a log begin a third of a second sooner.
                from hsr8.recorder.log.rerun_log import RerunLog  # noqa: PLC0415

                size = (scenario.camera.width, scenario.camera.height)
                name = f"{scenario.name} {scenario.seed}"
                file = run_folder.next_log(path)
                rerun_log = RerunLog(
                    file,
                    simulation.model,
                    simulation.layout,
                    size,
                    name,
                    gaze=scenario.navigation.gaze,
                    level=log,
                    live=live,
                    index=scenario.duration <= LONGEST_INDEXED,
                )
                writers.append(rerun_log)
                saved.append(rerun_log)
            self._listeners = writers + self._listeners
            if checkpoint:
                simulation.each_second = Checkpoints(self._metrics, path, checkpoint, saved)

    def resume(self, run: Run) -> None:
        """Go on from the checkpoint of `run`; call it before `into`.

        Raises:
            UsageError: there is none, or it cannot be trusted.
        """
        self._checkpoint = read_checkpoint(run, self._simulation)
        self._checkpoint.cut_back(run)
        self._metrics = self._checkpoint.metrics

    def run(self) -> Result:
        """Run to the end and write the results.

        Raises:
            RecordingFailed: its records cannot be written.
        """
        with self._failure_noted():
            return self._run()

    @contextmanager
    def _failure_noted(self) -> Iterator[None]:
        """The manifest of a run whose records cannot be written says so, if it can be."""
        try:
            yield
        except RecordingFailed:
            if self._folder is not None:
                with suppress(RecordingFailed):
                    self._folder.note(FAILED)
            raise

    def _run(self) -> Result:
        simulation = self._simulation
        simulation.listeners += [self._metrics, *self._listeners]
        diverged = ""
        try:
            parts = None if self._checkpoint is None else self._checkpoint.parts
            outcome = simulation.run(parts)
        except SimulationDiverged as error:
            diverged, outcome = str(error), simulation.outcome()
        results = self._metrics.result(outcome.exit_reason, outcome.state_hash)
        path = None if self._folder is None else self._folder.path
        if path is not None:
            run_folder.write_metrics(path, results)
        return Result(results, judge(simulation.scenario.criteria, results), path, diverged)
