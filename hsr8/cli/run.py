"""``hsr8 run``: one run, its folder and its result."""

import shlex
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from hsr8.cli import report
from hsr8.cli.crash import CrashReport
from hsr8.cli.options import Run
from hsr8.errors import SimulationDiverged
from hsr8.evaluation.metrics import Metrics
from hsr8.evaluation.verdict import exit_code, judge
from hsr8.gl import require_gl
from hsr8.loop import Simulation
from hsr8.recorder import atomic, run_folder
from hsr8.recorder.manifest import Manifest
from hsr8.recorder.progress import Progress
from hsr8.recorder.record import Listener
from hsr8.recorder.rerun_log import RerunLog
from hsr8.recorder.run_folder import RunFolder
from hsr8.scenario.loader import dump, load
from hsr8.scenario.schema import Scenario


def main(options: Run) -> int:
    """Run the scenario and report.

    Raises:
        UsageError: the scenario, a setting or the output folder will not do.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    scenario = load(options.scenario, overrides(options), options.seed)
    renderer = require_gl() if scenario.camera.source == "egl" else "analytic"
    command = rerun_command(options, scenario.seed)
    simulation = Simulation(scenario, scenario.seed)
    path = RunFolder.create(options.out, scenario.name, scenario.seed)
    manifest = Manifest.now(scenario.name, scenario.seed, command, renderer)
    with CrashReport(path):
        movers = len(simulation.layout.movers)
        folder = RunFolder(path, manifest, dump(scenario), movers)
        mission = scenario.navigation_parameters().mission
        metrics = Metrics(simulation.layout, mission.r_via, mission.r_goal)
        simulation.listeners.extend(_listeners(options, scenario, simulation, folder, metrics))
        message = ""
        with _interruptible(simulation):
            try:
                outcome = simulation.run()
                reason, state_hash = outcome.exit_reason, outcome.state_hash
            except SimulationDiverged as error:
                reason, state_hash, message = "diverged", simulation.state_hash(), str(error)
        results = metrics.result(reason, state_hash)
        folder.write_metrics(results)
    checks = judge(scenario.criteria, results)
    code = exit_code(reason, checks)
    if message:
        print(f"hsr8: {message}", file=sys.stderr)
    if options.json:
        print(atomic.dumps(results))
    elif not options.quiet:
        report.show(
            f"{scenario.name}, seed {scenario.seed}",
            results=results,
            checks=checks,
            path=path,
            command=command,
        )
    return code


def overrides(options: Run) -> tuple[str, ...]:
    """Options that are settings of the scenario, as ``key=value``; ``--set`` comes last."""
    settings = (
        ("duration", options.duration),
        ("robot.body", options.body),
        ("camera.source", options.camera),
    )
    return (
        *(f"{key}={value}" for key, value in settings if value is not None),
        *(setting for group in options.set for setting in group),
    )


def rerun_command(options: Run, seed: int) -> tuple[str, ...]:
    """Command line that repeats this run exactly."""
    words = ["hsr8", "run", options.scenario, "--seed", str(seed)]
    for flag, value in (
        ("--duration", options.duration),
        ("--body", options.body),
        ("--camera", options.camera),
    ):
        if value is not None:
            words += [flag, str(value)]
    for group in options.set:
        words += ["--set", *group]
    return tuple(shlex.quote(word) for word in words)


def _listeners(
    options: Run,
    scenario: Scenario,
    simulation: Simulation,
    folder: RunFolder,
    metrics: Metrics,
) -> list[Listener]:
    listeners: list[Listener] = [folder, metrics]
    if not options.no_log:
        camera = scenario.camera
        listeners.append(
            RerunLog(
                folder.path / run_folder.LOG,
                simulation.model,
                simulation.layout,
                (camera.width, camera.height),
                f"{scenario.name} {scenario.seed}",
            )
        )
    if not options.quiet:
        listeners.append(Progress(scenario.duration))
    return listeners


@contextmanager
def _interruptible(simulation: Simulation) -> Iterator[None]:
    """The first Ctrl-C ends the run after the present tick, the second at once."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        simulation.interrupt()

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
