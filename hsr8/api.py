"""Runs from Python: a scenario, a seed, and perhaps a planner or a gaze of one's own."""

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, SupportsIndex

from hsr8.decisions import GazeController, MotionPlanner
from hsr8.errors import UsageError
from hsr8.evaluation.recording import Recording, Result, renderer_of
from hsr8.loop import Simulation
from hsr8.recorder.log_level import LogLevel
from hsr8.recorder.record import Listener
from hsr8.recorder.run.manifest import OWN, Manifest
from hsr8.recorder.run.run_folder import SCENARIO, RunFolder
from hsr8.scenario.loader import as_words, load_scenario
from hsr8.scenario.schema import Scenario


def run(
    scenario: str | Path | Scenario,
    *,
    seed: SupportsIndex | None = None,
    settings: Sequence[str] | Mapping[str, Any] = (),
    out: str | Path | None = None,
    log: bool | str = True,
    planner: MotionPlanner | None = None,
    gaze: GazeController | None = None,
    listeners: Sequence[Listener] = (),
) -> Result:
    """Run a scenario.

    Args:
        scenario: name of a built-in one, a TOML file, or one that is loaded already.
        seed: of the world and every noise; the scenario's by default.
        settings: over the scenario's, as ``key=value`` or by key with dots.
        out: folder for the run folder; by default nothing is written.
        log: write the Rerun log into it too; ``"minimal"``, ``"standard"`` or ``"full"``.
        planner: plans the motion instead of the scenario's planner.
        gaze: chooses the gaze instead of the scenario's.
        listeners: told of every record.

    Raises:
        ScenarioError: the scenario or a setting is wrong, or its world cannot be drawn.
        RenderingUnavailable: the camera needs OpenGL and there is none.
        UsageError: the run folder cannot be made, there is no such level of `log`, or `planner`
            or `gaze` answers with what is no decision.
        RecordingFailed: the run folder cannot be written any more.
        TypeError: a loaded scenario is given settings.
        KeyboardInterrupt: Ctrl-C; the run folder is complete up to then.
    """
    level = _level(log)
    loaded = scenario if isinstance(scenario, Scenario) else load_scenario(str(scenario), settings)
    if isinstance(scenario, Scenario) and settings:
        raise TypeError("settings go with a scenario's name or file, not with a loaded one")
    loaded = loaded if seed is None else loaded.with_seed(seed)
    simulation = Simulation(loaded, loaded.seed, planner=planner, gaze=gaze)
    recording = Recording(simulation, listeners)
    if out is not None:
        renderer = renderer_of(loaded)
        path = RunFolder.create(Path(out), loaded.name, loaded.seed)
        source = path / SCENARIO if isinstance(scenario, Scenario) else scenario
        words = ("hsr8", "run", str(source), "--seed", str(loaded.seed), *_options(settings))
        command = _own(planner, gaze) or tuple(map(shlex.quote, words))
        manifest = Manifest.now(loaded.name, loaded.seed, command, renderer)
        recording.into(path, manifest, log=level)
    result = recording.run()
    if result.exit_reason == "interrupted":
        raise KeyboardInterrupt  # a loop over runs is to end, too
    return result


def _own(planner: MotionPlanner | None, gaze: GazeController | None) -> tuple[str, ...]:
    """The words of the call that names planner and gaze of one's own; none if there are none."""
    given = {"planner": planner, "gaze": gaze}
    names = [
        f"{key}={type(own).__module__}.{type(own).__qualname__}"
        for key, own in given.items()
        if own is not None
    ]
    return (f"{OWN}{', '.join(names)})",) if names else ()


def _level(log: bool | str) -> LogLevel | None:
    """How much is logged."""
    if isinstance(log, bool):
        return LogLevel.STANDARD if log else None
    if log not in tuple(LogLevel):
        raise UsageError(f"log={log!r}: give True, False or one of {', '.join(LogLevel)}")
    return LogLevel(log)


def _options(settings: Sequence[str] | Mapping[str, Any]) -> tuple[str, ...]:
    """Settings as options of the command line."""
    words = as_words(settings)
    return ("--set", *words) if words else ()
