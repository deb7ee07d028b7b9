"""``hsr8 run``: what was asked for is checked before anything heavy is loaded."""

import sys
from collections.abc import Sequence

from hsr8.cli.command_line import (
    checkpoint_period,
    log_level,
    option_tables,
    require_viewed,
    run_command,
    settings,
)
from hsr8.cli.cost import estimate
from hsr8.cli.loading import loading
from hsr8.cli.options import Run
from hsr8.errors import UsageError
from hsr8.gl import require_gl
from hsr8.plugin_file import require_plugins
from hsr8.recorder.files import atomic
from hsr8.recorder.files.new_folder import require_new_folder
from hsr8.render.live_view import require_display
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario


def main(options: Run) -> int:
    """Run the scenario and report.

    Raises:
        UsageError: the scenario, a setting or the output folder will not do.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    period = checkpoint_period(options)
    if options.resume:
        with loading():
            from hsr8.cli.recorded_run import resume  # noqa: PLC0415  takes seconds

        return resume(options)
    scenario = load_scenario(
        options.scenario, settings(options), options.seed, options=option_tables(options)
    )
    if period and scenario.plugin.named:
        raise UsageError("--checkpoint: nobody knows how to save a planner or a gaze of one's own")
    command = run_command(options, scenario.seed)
    if options.dry_run:
        _require_all(options, scenario)
        command += ("--view", options.view) if options.view else ()
        command += ("--verify-determinism",) if options.verify_determinism else ()
        _tell_cost(options, scenario, command)
        return 0
    if not options.quiet:
        print(f"{scenario.name}, seed {scenario.seed}", file=sys.stderr, flush=True)
    with loading():
        from hsr8.cli.recorded_run import start  # noqa: PLC0415  takes seconds

    return start(options, scenario, command)


def _require_all(options: Run, scenario: Scenario) -> None:
    """Make sure that the run can begin.

    Raises:
        UsageError: a part of it cannot be made.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    require_viewed(options, log_level(options))
    if options.view is not None:
        require_display(options.view)
    require_new_folder(options.out / scenario.name, "run folder")
    require_plugins(scenario.plugin)
    if scenario.camera.source == "rendered":
        require_gl()
    with loading():
        from hsr8.loop import Simulation  # noqa: PLC0415  takes seconds

    Simulation(scenario, scenario.seed)


def _tell_cost(options: Run, scenario: Scenario, command: Sequence[str]) -> None:
    """What the run would take."""
    cost = estimate(scenario, log=log_level(options))
    folder = options.out / scenario.name
    if options.json:
        told = {
            "scenario": scenario.name,
            "seed": scenario.seed,
            "folder": str(folder),
            "simulated_time_s": cost.simulated,
            "estimated_wall_time_s": round(cost.wall, 1),
            "estimated_disk_mb": round(cost.disk, 1),
            "command": " ".join(command),
        }
        print(atomic.dumps(told))
        return
    print(f"would run   {scenario.name}, seed {scenario.seed}, into a new folder in {folder}")
    print(f"simulated   {cost.simulated:g} s at most")
    print(f"takes       about {cost.wall:.0f} s on two cores, {cost.disk:.0f} MB")
    print(f"for real    {' '.join(command)}")
