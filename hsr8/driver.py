"""The driver of runs: a simulation, its tables, and the results that follow from them."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from types import TracebackType
from typing import Self

from hsr8.errors import RecordingFailed
from hsr8.measure.metrics import measure
from hsr8.plugins.decisions import GazePlugin, PlannerPlugin
from hsr8.plugins.walker import CustomWalker
from hsr8.process.compilation_watch import CompilationWatch
from hsr8.process.gl import require_gl
from hsr8.process.signals import stop_on_signals
from hsr8.recording.manifest import CALL, FAILED
from hsr8.recording.recorder import IMAGES, PERIOD, Recorder, Sink
from hsr8.recording.run import Run, open_run
from hsr8.recording.run_folder import RunFolder
from hsr8.scenario.schema import Scenario
from hsr8.simulation.drive import Drive
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import Tick

LIVE_PERIOD = PERIOD // 2  # ticks of a batch while a viewer is connected
COMPILING = CompilationWatch().__enter__()  # of this process, since the import of this module


def run_scenario(
    scenario: Scenario,
    path: Path | None = None,
    command: Sequence[str] = (f"{CALL}...)",),
    *,
    live: str = "",
    on_tick: Callable[[Tick], None] | None = None,
    planner: PlannerPlugin | None = None,
    gaze: GazePlugin | None = None,
    walker: CustomWalker | None = None,
    drive: Drive | None = None,
) -> Run:
    """Run a scenario to the end, record and measure it.

    The first SIGINT or SIGTERM ends the run after the current tick.

    Args:
        scenario: scenario with the seed of the run.
        path: new folder of the run; None keeps it in memory.
        command: words of the command line that repeats the run.
        live: address of a viewer that shows the log during the run; empty for none.
        on_tick: receives every control tick.
        planner: replaces the planner of the scenario.
        gaze: replaces the gaze controller of the scenario.
        walker: replaces the walking engine of the scenario.
        drive: commands from outside.

    Raises:
        ScenarioError: the world cannot be drawn.
        RenderingUnavailable: the camera needs OpenGL and there is none.
        UsageError: a plugin cannot be read, or returned an invalid value.
        RecordingFailed: the folder cannot be written.
    """
    source = scenario.camera.source
    renderer = require_gl() if source == "rendered" else source
    simulation = Simulation(scenario, planner=planner, gaze=gaze, walker=walker, drive=drive)
    with stop_on_signals(simulation.interrupt):
        recording = Recording(simulation, RunFolder(path, scenario, command, renderer), live=live)
        with suppress(KeyboardInterrupt), recording:
            for tick in simulation:
                recording.append(tick)
                if on_tick is not None:
                    on_tick(tick)
    return recording.run()


class Recording:
    """Recording of a simulation that its caller drives: a context for its ticks, then a run.

    Args:
        simulation: simulation that is not yet started; the context starts it.
        folder: receives tables and results.
        live: address of a viewer that shows the log during the run; empty for none.

    Attributes:
        exit_reason: reason of the caller to end the run; by default that of the simulation.

    Raises:
        RecordingFailed: here and in every method, the folder cannot be written.
    """

    def __init__(self, simulation: Simulation, folder: RunFolder, *, live: str = "") -> None:
        self.exit_reason = ""
        self._started, self._compiled = perf_counter(), COMPILING.seconds
        self._simulation, self._folder = simulation, folder
        scenario = simulation.scenario
        sinks: list[Sink] = [folder]
        if live:
            # Imported late: runs without a viewer start 0.2 s earlier.
            from hsr8.show.log.run_log import RunLog  # noqa: PLC0415

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
        with ExitStack() as opened:
            opened.callback(self._end)
            opened.enter_context(self._simulation)
            self._opened = opened.pop_all()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            self._opened.__exit__(kind, error, traceback)
        except RecordingFailed:
            self._fail()
            raise
        if isinstance(error, RecordingFailed):
            self._fail()

    def append(self, tick: Tick) -> None:
        """Record one control tick."""
        self._recorder.append(tick)

    def run(self) -> Run:
        """Return the measured run, after the context."""
        simulation = self._simulation
        try:
            results = measure(self._read(), simulation.layout, simulation.certificate)
            self._folder.write_metrics(results)
        except RecordingFailed:
            self._fail()
            raise
        return self._read()

    @property
    def _reason(self) -> str:
        return self.exit_reason or self._simulation.exit_reason or "error"

    def _read(self) -> Run:
        if self._folder.path is not None:
            return open_run(self._folder.path)
        return Run(None, asdict(self._folder.manifest), memory=self._folder.memory)

    def _end(self) -> None:
        """Write the last rows and the end of the manifest."""
        reason = self._reason
        self._recorder.close(reason)
        compiling = COMPILING.seconds - self._compiled
        self._folder.end(
            reason,
            state_hash="" if reason == "error" else self._simulation.state_hash(),
            wall_time_s=perf_counter() - self._started - compiling,
        )

    def _fail(self) -> None:
        """Note that the records could not be written."""
        with suppress(RecordingFailed):
            self._folder.end(FAILED, rows={})
