"""One run of ``hsr8 run``, its folder and its result."""

import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from hsr8.cli import report, termination
from hsr8.cli.command_line import checkpoint_period, log_level, option_tables, require_viewed
from hsr8.cli.crash import CrashReport
from hsr8.cli.options import Run
from hsr8.cli.progress import Progress
from hsr8.cli.verify import ENDED, Verified, verify
from hsr8.errors import UsageError
from hsr8.evaluation.recording import Recording, Result, renderer_of
from hsr8.evaluation.verdict import Check, exit_code
from hsr8.loop import Simulation
from hsr8.recorder.files import atomic
from hsr8.recorder.files.writing import FAILED
from hsr8.recorder.log_level import LogLevel
from hsr8.recorder.run.manifest import RUNNING, Manifest
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.recorder.run.run_reader import open_run
from hsr8.render.live_view import LiveView, live_view
from hsr8.scenario.schema import Scenario

SIGNALS = (signal.SIGINT, signal.SIGTERM)


def start(options: Run, scenario: Scenario, command: Sequence[str]) -> int:
    """Run the scenario and report.

    Args:
        options: as they were given.
        scenario: what to run.
        command: words of the command line that makes exactly this run.

    Raises:
        ScenarioError: the world cannot be drawn.
        UsageError: the output folder will not do.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    manifest = Manifest.now(scenario.name, scenario.seed, command, renderer_of(scenario))
    log, period = log_level(options), checkpoint_period(options)
    recording, simulation = _recording(scenario, _progress(options, scenario))
    with _view(options, log) as view:
        path = RunFolder.create(options.out, scenario.name, scenario.seed)
        with CrashReport(path), _interruptible(simulation):
            recording.into(path, manifest, log=log, live=_address(view), checkpoint=period)
            result = recording.run()
        return _told(options, result, manifest, view)


def resume(options: Run) -> int:
    """Go on with a run that was killed, and report.

    Raises:
        UsageError: there is nothing to go on with.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    _alone(options)
    run = open_run(Path(options.scenario))
    reason = run.manifest.get("exit_reason")
    if reason not in (RUNNING, FAILED, "interrupted"):
        raise UsageError(f"{run.path} has nothing to go on with: it ended by {reason!r}")
    manifest = Manifest.read(run.manifest, run.path)
    given = options.no_log or options.log_level
    log = log_level(options) if given else manifest.log_level
    period = checkpoint_period(options) or manifest.checkpoint
    scenario = run.scenario()
    progress = _progress(options, scenario)
    recording, simulation = _recording(scenario, progress)
    with _view(options, log) as view:
        with CrashReport(run.path), _interruptible(simulation):
            recording.resume(run)
            if progress is not None:
                progress.recall(run.events())
            recording.into(run.path, manifest, log=log, live=_address(view), checkpoint=period)
            result = recording.run()
        return _told(options, result, manifest, view)


def _alone(options: Run) -> None:
    """A run goes on as what it was."""
    given = option_tables(options).keys() | ({"--set"} if options.set else set())
    given |= {"--seed"} if options.seed is not None else set()
    given |= {"--dry-run"} if options.dry_run else set()
    given |= {"--out"} if options.out != Run.out else set()
    if given:
        raise UsageError(f"{', '.join(sorted(given))} cannot be given with --resume")


def _progress(options: Run, scenario: Scenario) -> Progress | None:
    return None if options.quiet else Progress(scenario.duration)


def _recording(scenario: Scenario, progress: Progress | None) -> tuple[Recording, Simulation]:
    simulation = Simulation(scenario, scenario.seed)
    return Recording(simulation, () if progress is None else (progress,)), simulation


@contextmanager
def _view(options: Run, log: LogLevel | None) -> Iterator[LiveView | None]:
    """The viewer that was asked for, if one was."""
    require_viewed(options, log)
    if options.view is None:
        yield None
        return
    with termination.like_ctrl_c(), live_view(options.view) as view:
        if view.page:
            print(f"watch it in a browser on this machine:  {view.page}", file=sys.stderr)
        yield view


def _address(view: LiveView | None) -> str:
    return "" if view is None else view.address


def _told(options: Run, result: Result, manifest: Manifest, view: LiveView | None) -> int:
    """Verify and report, and leave time to look; the exit code."""
    assert result.folder is not None
    results, checks = result.metrics, result.checks
    code = exit_code(result.exit_reason, checks)
    if options.verify_determinism and code in ENDED:
        verified = verify(result.folder)
        results["deterministic"] = verified.equal
        checks = (*checks, _deterministic(verified))
        code = exit_code(result.exit_reason, checks)
    if result.diverged:
        print(f"hsr8: {result.diverged}", file=sys.stderr)
    if options.json:
        print(atomic.dumps(results))
    elif not options.quiet:
        report.show(
            f"{manifest.scenario}, seed {manifest.seed}",
            results=results,
            checks=checks,
            path=result.folder,
            command=manifest.command,
        )
    if view is not None and result.exit_reason != "interrupted":
        print(f"{'Ctrl-C' if view.page else 'closing the window'} ends the viewer", file=sys.stderr)
        view.wait()
    return code


def _deterministic(verified: Verified) -> Check:
    """The second run as one more criterion."""
    found = f"{verified.hashes} hashes equal"
    if not verified.equal:
        found = f"{verified.difference}; second run: {verified.second}"
    return Check("the same in another process", "every bit", found, verified.equal)


@contextmanager
def _interruptible(simulation: Simulation) -> Iterator[None]:
    """Ctrl-C or SIGTERM ends the run after the present tick, a second one at once."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        signal.signal(number, signal.default_int_handler)
        simulation.interrupt()

    before = {number: signal.signal(number, interrupt) for number in SIGNALS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
