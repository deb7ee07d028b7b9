"""A simulation whose results are measured and which writes a run folder."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import TYPE_CHECKING, Any

from hsr8 import arithmetic
from hsr8.compilation_watch import CompilationWatch
from hsr8.errors import RecordingFailed
from hsr8.evaluation import metrics
from hsr8.evaluation.verdict import Criterion, evaluate_criteria
from hsr8.files.writing import FAILED
from hsr8.gl import require_gl
from hsr8.loop import Simulation
from hsr8.plugin_file import digests
from hsr8.record import Tick
from hsr8.recorder.log_level import RATES, LogLevel, LogRates
from hsr8.recorder.recorder import PERIOD, Recorder
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.recorder.selection import Selection
from hsr8.robots.locate import digest
from hsr8.scenario.loader import dump
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track_file import track_digests

if TYPE_CHECKING:
    from hsr8.recorder.log.rerun_log import RerunLog

LIVE_PERIOD = PERIOD // 2  # ticks of a batch while a viewer is connected


@dataclass(frozen=True, slots=True)
class Result:
    """Results of a run.

    Attributes:
        metrics: every result by name, as in ``metrics.json``.
        criteria: the scenario's criteria, evaluated.
        folder: run folder, None if nothing was written.
        diverged: message of the divergence; empty if the physics did not diverge.
        arithmetic: that of NumPy: ``x86-64-v3``, the same on all processors, or ``native``.
    """

    metrics: dict[str, Any]
    criteria: tuple[Criterion, ...]
    folder: Path | None = None
    diverged: str = ""
    arithmetic: str = arithmetic.IN_FORCE

    @property
    def exit_reason(self) -> str:
        """goal, timeout, completed, fall, diverged or interrupted."""
        return str(self.metrics["exit_reason"])

    @property
    def criteria_met(self) -> bool:
        """Whether the run ended by itself and met every criterion of its scenario."""
        ended = self.exit_reason not in ("diverged", "interrupted")
        return ended and all(criterion.met for criterion in self.criteria)


def renderer_of(scenario: Scenario) -> str:
    """Return the name of the renderer of the head camera.

    Raises:
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    return require_gl() if scenario.camera.source == "rendered" else scenario.camera.source


class Recording:
    """A simulation that is recorded and measured.

    Without a folder, the tables of the run are temporary.

    Args:
        simulation: not yet started.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._started = perf_counter()
        self._simulation = simulation
        self._log: RerunLog | None = None
        self._period = PERIOD
        self._folder: RunFolder | None = None
        self._images: LogRates | None = None

    def into(
        self,
        path: Path,
        manifest: Manifest,
        *,
        log: LogLevel | None = LogLevel.STANDARD,
        live: str = "",
    ) -> None:
        """Record into a folder.

        Args:
            path: new run folder.
            manifest: of the run.
            log: level of detail of the Rerun log; None for no log.
            live: address of a viewer that shows the log during the run; empty for none.

        Raises:
            RecordingFailed: the folder cannot be written.
        """
        simulation, scenario = self._simulation, self._simulation.scenario
        libraries = manifest.libraries | digests(scenario.plugin) | digest(scenario.robot.model)
        libraries |= track_digests(scenario.world.mover)
        manifest = replace(manifest, libraries=libraries, log=log or "")
        self._folder = RunFolder(path, manifest, dump(scenario))
        self._images = None if log is None else RATES[log]
        with self._failure_noted():
            if log is not None:
                # Imported late: runs without a log start a third of a second earlier.
                from hsr8.recorder.log.rerun_log import RerunLog  # noqa: PLC0415

                world = simulation.model, simulation.humanoid, simulation.layout
                self._log = RerunLog(path / run_folder.LOG, world, scenario, level=log, live=live)
                self._period = LIVE_PERIOD if live else PERIOD

    def run(self, on_tick: Callable[[Tick], None] | None = None) -> Result:
        """Run to the end and write the results.

        Args:
            on_tick: receives every control tick.

        Raises:
            RecordingFailed: the records cannot be written.
        """
        with self._failure_noted():
            return self._run(on_tick)

    @contextmanager
    def _failure_noted(self) -> Iterator[None]:
        """Note in the manifest, if possible, that the records could not be written."""
        try:
            yield
        except RecordingFailed:
            if self._folder is not None:
                with suppress(RecordingFailed):
                    self._folder.note(FAILED, {})
            raise

    def _run(self, on_tick: Callable[[Tick], None] | None) -> Result:
        simulation, diverged = self._simulation, ""
        path = None if self._folder is None else self._folder.path
        selection = Selection(metrics.COLUMNS)
        with ExitStack() as stack:
            folder = path or Path(stack.enter_context(TemporaryDirectory(prefix="hsr8-")))
            compiling = stack.enter_context(CompilationWatch())
            recorder = Recorder(
                folder,
                simulation.humanoid.model.names,
                scale=simulation.layout.scale,
                images=self._images,
                listeners=[selection] if self._log is None else [selection, self._log.add],
                period=self._period,
            )
            with suppress(KeyboardInterrupt), ExitStack() as open_:
                open_.callback(self._note, recorder)
                open_.callback(self._close_log)
                open_.enter_context(recorder)  # first, to close its files if the camera fails
                open_.enter_context(simulation)
                for tick in simulation:
                    recorder.append(tick)
                    if on_tick is not None:
                        on_tick(tick)
                    diverged = next((e.text for e in tick.events if e.kind == "diverged"), "")
            wall_time = perf_counter() - self._started - compiling.seconds
        outcome = simulation.outcome()
        results = metrics.metrics(
            selection.tables(),
            simulation.layout,
            simulation.scenario.navigation.mission,
            certificate=simulation.certificate,
            exit_reason=outcome.exit_reason,
            state_hash=outcome.state_hash,
            wall_time=wall_time,
        )
        if path is not None:
            run_folder.write_metrics(path, results)
        criteria = evaluate_criteria(simulation.scenario.criteria, results)
        return Result(results, criteria, path, diverged)

    def _close_log(self) -> None:
        if self._log is not None:
            self._log.close(self._simulation.exit_reason or "error")

    def _note(self, recorder: Recorder) -> None:
        if self._folder is not None:
            self._folder.note(self._simulation.exit_reason or "error", recorder.rows)
