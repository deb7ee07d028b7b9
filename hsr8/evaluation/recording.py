"""A simulation whose results are measured, and which leaves a run folder behind."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hsr8.errors import SimulationDiverged
from hsr8.evaluation.metrics import Metrics
from hsr8.evaluation.verdict import Check, judge
from hsr8.gl import require_gl
from hsr8.loop import Simulation
from hsr8.recorder import run_folder
from hsr8.recorder.manifest import Manifest
from hsr8.recorder.record import Listener
from hsr8.recorder.rerun_log import RerunLog
from hsr8.recorder.run_folder import RunFolder
from hsr8.recorder.tape import TapeWriter
from hsr8.recorder.walking_table import WalkingTableWriter
from hsr8.scenario.loader import dump
from hsr8.scenario.schema import Scenario


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
    return require_gl() if scenario.camera.source == "egl" else scenario.camera.source


def folder_listeners(
    simulation: Simulation, path: Path, manifest: Manifest, *, log: bool
) -> list[Listener]:
    """Give a simulation its tape; what else writes into its run folder, the folder first."""
    scenario, layout = simulation.scenario, simulation.layout
    folder = RunFolder(path, manifest, dump(scenario), len(layout.movers))
    simulation.tape = TapeWriter(path / run_folder.TAPE)
    table = WalkingTableWriter(path / run_folder.WALKING, simulation.model, simulation.index)
    listeners: list[Listener] = [folder, table]
    if log:
        size = (scenario.camera.width, scenario.camera.height)
        name = f"{scenario.name} {scenario.seed}"
        file = path / run_folder.LOG
        listeners.append(RerunLog(file, simulation.model, layout, size, name))
    return listeners


def run_and_measure(
    simulation: Simulation, listeners: Sequence[Listener], folder: Path | None
) -> Result:
    """Run a simulation to its end.

    Args:
        simulation: not yet begun.
        listeners: told of everything beside those it has.
        folder: where the results go too; None for nowhere.
    """
    mission = simulation.scenario.navigation_parameters().mission
    metrics = Metrics(simulation.layout, mission.r_via, mission.r_goal)
    simulation.listeners += [metrics, *listeners]
    diverged = ""
    try:
        simulation.run()
    except SimulationDiverged as error:
        diverged = str(error)
    outcome = simulation.outcome()
    results = metrics.result(outcome.exit_reason, outcome.state_hash)
    if folder is not None:
        run_folder.write_metrics(folder, results)
    return Result(results, judge(simulation.scenario.criteria, results), folder, diverged)
