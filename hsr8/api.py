"""Runs from Python, with an optional custom planner, gaze controller or walker."""

from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import SupportsIndex

import tomlkit

from hsr8.driver import run_scenario
from hsr8.errors import UsageError
from hsr8.files.atomic import require_temporary
from hsr8.files.text import shell_line
from hsr8.plugins.decisions import GazePlugin, PlannerPlugin
from hsr8.plugins.walker import CustomWalker
from hsr8.recording.manifest import CALL
from hsr8.recording.run import Run
from hsr8.recording.run_folder import SCENARIO, new_run_folder
from hsr8.scenario.layers import Given, settings_of
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario


def run(
    scenario: str | Path | Scenario,
    *,
    seed: SupportsIndex | None = None,
    settings: Given = (),
    out: str | Path | None = None,
    log: bool = False,
    planner: PlannerPlugin | None = None,
    gaze: GazePlugin | None = None,
    walker: CustomWalker | None = None,
) -> Run:
    """Run a scenario.

    Args:
        scenario: name of a built-in scenario, TOML file, or loaded scenario.
        seed: seed of the world and of all noise; default: that of the scenario.
        settings: override those of the scenario, as ``key=value`` or by dotted key.
        out: parent folder of the run folder; by default no files are kept.
        log: whether the Rerun log is written into the run folder.
        planner: replaces the planner of the scenario.
        gaze: replaces the gaze controller of the scenario.
        walker: replaces the walking engine of the scenario.

    Raises:
        ScenarioError: the scenario or a setting is invalid, or its world cannot be drawn.
        RenderingUnavailable: the camera needs OpenGL and there is none.
        UsageError: the run folder cannot be made, `log` is given without `out`, or `planner`,
            `gaze` or `walker` returned an invalid value.
        RecordingFailed: the run folder can no longer be written.
        TypeError: settings were given for a loaded scenario.
        KeyboardInterrupt: Ctrl-C; the run folder is complete up to then.
    """
    if log and out is None:
        raise UsageError("log: needs a folder, got out=None; expected the parent of run folders")
    if log:
        require_temporary()
    loaded = scenario if isinstance(scenario, Scenario) else load_scenario(str(scenario), settings)
    if isinstance(scenario, Scenario) and settings:
        raise TypeError("settings: need the name or file of a scenario, got a loaded scenario")
    loaded = loaded if seed is None else loaded.with_seed(seed)
    with ExitStack() as stack:
        path = None
        if out is not None:
            path = stack.enter_context(new_run_folder(Path(out), loaded.name, loaded.seed))
        source = path and path / SCENARIO if isinstance(scenario, Scenario) else scenario
        words = ["hsr8", "run", str(source), "--seed", str(loaded.seed)]
        words += ["--set", *_words(settings)] if settings else []
        call = _call({"planner": planner, "gaze": gaze, "walker": walker})
        command = call or (shell_line(words),)
        made = run_scenario(loaded, path, command, planner=planner, gaze=gaze, walker=walker)
        if log:
            from hsr8.show.log.run_log import write_log  # noqa: PLC0415  takes 0.2 s

            write_log(made)
    if made.exit_reason == "interrupted":
        raise KeyboardInterrupt  # also ends a loop over runs
    return made


def _words(settings: Given) -> list[str]:
    """Return settings as ``key=value``."""
    if isinstance(settings, str):
        return [settings]
    if not isinstance(settings, Mapping):
        return list(settings)
    pairs = [(".".join(s.key), tomlkit.item([s.value])) for s in settings_of(settings)]
    return [f"{key}={value.as_string()[1:-1]}" for key, value in pairs]


def _call(plugins: Mapping[str, object]) -> tuple[str, ...]:
    """Return the call with the classes of user-defined objects; empty without them."""
    names = [
        f"{key}={type(value).__module__}.{type(value).__qualname__}"
        for key, value in plugins.items()
        if value is not None
    ]
    return (f"{CALL}{', '.join(names)})",) if names else ()
