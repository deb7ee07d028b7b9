"""Simulations that are recorded and measured, in memory or in a run folder."""

from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from types import TracebackType
from typing import Any, Self

from hsr8 import arithmetic
from hsr8.compilation_watch import CompilationWatch
from hsr8.errors import RecordingFailed
from hsr8.evaluation import metrics
from hsr8.evaluation.verdict import Criterion, evaluate_criteria
from hsr8.files.writing import FAILED
from hsr8.gl import require_gl
from hsr8.loop import Simulation
from hsr8.record import Tick
from hsr8.recorder.recorder import IMAGES, PERIOD, Memory, Recorder, Sink
from hsr8.recorder.run.manifest import CALL, Manifest
from hsr8.recorder.run.run import MemoryRun, Run
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.recorder.run.run_reader import open_run
from hsr8.scenario.schema import Scenario

LIVE_PERIOD = PERIOD // 2  # ticks of a batch while a viewer is connected


@dataclass(frozen=True, slots=True)
class Result:
    """Results of a run.

    Attributes:
        run: the run with its tables, in memory or in a folder.
        metrics: every result by name, as in ``metrics.json``.
        criteria: the scenario's criteria, evaluated.
        diverged: message of the divergence; empty if the physics did not diverge.
        arithmetic: arithmetic of NumPy: ``x86-64-v3``, the same on all processors, or ``native``.
    """

    run: Run
    metrics: dict[str, Any]
    criteria: tuple[Criterion, ...]
    diverged: str = ""
    arithmetic: str = arithmetic.IN_FORCE

    @property
    def folder(self) -> Path | None:
        """Run folder, None if nothing was written."""
        return self.run.path

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
    """Recording of a simulation that its caller drives: a context for its ticks, then a result.

    Args:
        simulation: simulation that is not yet started; the context starts it.
        folder: receives tables and results; None keeps them in memory.
        live: address of a viewer that shows the log during the run; empty for none.

    Raises:
        RecordingFailed: here and in every method, the folder cannot be written.
    """

    def __init__(
        self, simulation: Simulation, folder: RunFolder | None = None, *, live: str = ""
    ) -> None:
        self._started, self._wall_time, self._diverged = perf_counter(), 0.0, ""
        self._simulation, self._folder = simulation, folder
        self._compiling, self._opened = CompilationWatch(), ExitStack()
        scenario = simulation.scenario
        self._memory = Memory() if folder is None else Memory(metrics.COLUMNS)
        sinks: list[Sink] = [self._memory] if folder is None else [folder, self._memory]
        if live:
            # Imported late: runs without a viewer start 0.2 s earlier.
            from hsr8.rerun_log.run_log import RunLog  # noqa: PLC0415

            world = simulation.model, simulation.humanoid, simulation.layout
            sinks.append(RunLog(live, world, scenario, name=f"{scenario.name} {scenario.seed}"))
        self._recorder = Recorder(
            simulation.humanoid.model.names,
            sinks,
            scale=simulation.layout.scale,
            images=IMAGES[scenario.recorder.images],
            period=LIVE_PERIOD if live else PERIOD,
        )

    def __enter__(self) -> Self:
        self._opened.enter_context(self._compiling)
        self._opened.callback(self._close)
        self._opened.enter_context(self._simulation)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._opened.__exit__(kind, error, traceback)
        self._wall_time = perf_counter() - self._started - self._compiling.seconds

    def append(self, tick: Tick) -> None:
        """Record one control tick."""
        self._recorder.append(tick)
        self._diverged = next((e.text for e in tick.events if e.kind == "diverged"), "")

    def result(self, exit_reason: str = "") -> Result:
        """Return the result, after the context.

        Args:
            exit_reason: reason of the caller to end the run; by default that of the simulation.
        """
        simulation, scenario = self._simulation, self._simulation.scenario
        reason = exit_reason or simulation.outcome().exit_reason
        tables = self._memory.tables()
        results = metrics.metrics(
            tables,
            simulation.layout,
            scenario.navigation.mission,
            certificate=simulation.certificate,
            exit_reason=reason,
            state_hash=simulation.state_hash(),
            wall_time=self._wall_time,
        )
        run: Run
        if self._folder is not None:
            self._folder.write_metrics(results)
            run = open_run(self._folder.path)
        else:
            rows = {name: len(table) for name, table in tables.items()}
            manifest = Manifest.now(scenario, (f"{CALL}...)",), scenario.camera.source)
            ended = manifest.ended(reason, rows)
            run = MemoryRun(None, asdict(ended), scenario, tables, results)
        criteria = evaluate_criteria(scenario.criteria, results)
        return Result(run, results, criteria, self._diverged)

    def _close(self) -> None:
        self._recorder.close(self._simulation.exit_reason or "error")


def record(
    simulation: Simulation,
    folder: RunFolder | None = None,
    *,
    live: str = "",
    on_tick: Callable[[Tick], None] | None = None,
) -> Result:
    """Run a simulation to the end and measure it.

    Args:
        simulation: simulation that is not yet started.
        folder: receives tables and results; None keeps them in memory.
        live: address of a viewer that shows the log during the run; empty for none.
        on_tick: receives every control tick.

    Raises:
        RecordingFailed: the folder cannot be written.
    """
    try:
        recording = Recording(simulation, folder, live=live)
        with suppress(KeyboardInterrupt), recording:
            for tick in simulation:
                recording.append(tick)
                if on_tick is not None:
                    on_tick(tick)
        return recording.result()
    except RecordingFailed:
        if folder is not None:
            with suppress(RecordingFailed):
                folder.note(FAILED, {})
        raise
