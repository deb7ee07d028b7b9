"""Simulations that are recorded and measured, in memory or in a run folder."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

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
from hsr8.recorder.memory import Memory
from hsr8.recorder.recorder import IMAGES, PERIOD, Recorder, Sink
from hsr8.recorder.run.manifest import CALL, Manifest
from hsr8.recorder.run.run import MemoryRun, Run
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.recorder.run.run_reader import open_run
from hsr8.robots.locate import digest
from hsr8.scenario.loader import dump
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track_file import track_digests

LIVE_PERIOD = PERIOD // 2  # ticks of a batch while a viewer is connected


@dataclass(frozen=True, slots=True)
class Result:
    """Results of a run.

    Attributes:
        run: the run with its tables, in memory or in a folder.
        metrics: every result by name, as in ``metrics.json``.
        criteria: the scenario's criteria, evaluated.
        diverged: message of the divergence; empty if the physics did not diverge.
        arithmetic: that of NumPy: ``x86-64-v3``, the same on all processors, or ``native``.
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


def started_folder(
    path: Path, scenario: Scenario, command: Sequence[str], renderer: str
) -> RunFolder:
    """Write manifest and scenario of a run into its folder.

    Args:
        path: new folder.
        scenario: scenario with the seed of the run.
        command: words of the command line that repeats the run.
        renderer: name of the renderer of the head camera.

    Raises:
        RecordingFailed: the folder cannot be written.
    """
    manifest = _manifest(scenario, command, renderer)
    return RunFolder(path, manifest, dump(scenario))


def _manifest(scenario: Scenario, command: Sequence[str], renderer: str) -> Manifest:
    manifest = Manifest.now(scenario.name, scenario.seed, command, renderer)
    libraries = manifest.libraries | digests(scenario.plugin) | digest(scenario.robot.model)
    libraries |= track_digests(scenario.world.mover)
    return replace(manifest, libraries=libraries)


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
        return _record(simulation, folder, live, on_tick)
    except RecordingFailed:
        if folder is not None:
            with suppress(RecordingFailed):
                folder.note(FAILED, {})
        raise


def _record(
    simulation: Simulation,
    folder: RunFolder | None,
    live: str,
    on_tick: Callable[[Tick], None] | None,
) -> Result:
    started, diverged, scenario = perf_counter(), "", simulation.scenario
    memory = Memory() if folder is None else Memory(metrics.COLUMNS)
    sinks: list[Sink] = [memory] if folder is None else [folder, memory]
    if live:
        # Imported late: runs without a viewer start a third of a second earlier.
        from hsr8.rerun_log.run_log import RunLog  # noqa: PLC0415

        world = simulation.model, simulation.humanoid, simulation.layout
        sinks.append(RunLog(live, world, scenario, name=f"{scenario.name} {scenario.seed}"))
    with CompilationWatch() as compiling:
        recorder = Recorder(
            simulation.humanoid.model.names,
            sinks,
            scale=simulation.layout.scale,
            images=IMAGES[scenario.recorder.images],
            period=LIVE_PERIOD if live else PERIOD,
        )
        with suppress(KeyboardInterrupt), ExitStack() as opened:
            opened.callback(lambda: recorder.close(simulation.exit_reason or "error"))
            opened.enter_context(simulation)
            for tick in simulation:
                recorder.append(tick)
                if on_tick is not None:
                    on_tick(tick)
                diverged = next((e.text for e in tick.events if e.kind == "diverged"), "")
        wall_time = perf_counter() - started - compiling.seconds
    results = metrics.metrics(
        tables := memory.tables(),
        simulation.layout,
        scenario.navigation.mission,
        certificate=simulation.certificate,
        exit_reason=simulation.outcome().exit_reason,
        state_hash=simulation.outcome().state_hash,
        wall_time=wall_time,
    )
    run: Run
    if folder is not None:
        folder.write_metrics(results)
        run = open_run(folder.path)
    else:
        rows = {name: len(table) for name, table in tables.items()}
        manifest = _manifest(scenario, (f"{CALL}...)",), scenario.camera.source)
        ended = manifest.ended(str(results["exit_reason"]), rows)
        run = MemoryRun(None, asdict(ended), scenario, tables, results)
    return Result(run, results, evaluate_criteria(scenario.criteria, results), diverged)
