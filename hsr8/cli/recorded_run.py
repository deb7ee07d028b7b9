"""One run of ``hsr8 run``, its folder and its result."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, redirect_stdout
from typing import TYPE_CHECKING

from rich.console import Console

from hsr8.cli import report
from hsr8.cli.first_compilation import two_processes
from hsr8.cli.options import Run
from hsr8.cli.progress import Pace, Progress
from hsr8.driver import run_scenario
from hsr8.errors import Hsr8Error
from hsr8.files import atomic
from hsr8.files.atomic import require_temporary
from hsr8.files.text import shell_word
from hsr8.process.gl import require_gl
from hsr8.recording.crash import crash_report
from hsr8.recording.run import Run as RecordedRun
from hsr8.recording.run_folder import VIDEO, new_run_folder
from hsr8.recording.verdict import exit_code
from hsr8.scenario.schema import Scenario
from hsr8.simulation.drive import Drive
from hsr8.simulation.record import Tick

if TYPE_CHECKING:
    from hsr8.show.viewer import LiveView

BAG = "bag"  # folder in that of the run


def start(options: Run, scenario: Scenario, command: Sequence[str]) -> int:
    """Run the scenario and report.

    Args:
        options: options of the command.
        scenario: scenario to run.
        command: words of the command line that makes exactly this run.

    Raises:
        ScenarioError: the world cannot be drawn.
        UsageError: the output folder is invalid.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    if options.bag:
        from hsr8.export.bag import require_rosbags  # noqa: PLC0415  with the exports

        require_rosbags()
    if options.ros:
        from hsr8.ros.live import require_zenoh  # noqa: PLC0415  with the exports

        require_zenoh()
    if options.video:
        require_gl()
    if options.log or options.view:
        require_temporary()
    with two_processes(scenario.camera.source, quiet=options.quiet):
        return _start(options, scenario, command)


def _start(options: Run, scenario: Scenario, command: Sequence[str]) -> int:
    new = new_run_folder(options.out, scenario.name, scenario.seed)  # before any compilation
    with new as path, _view(options) as view:
        with crash_report(path), ExitStack() as opened:
            if options.json:  # standard output is the result alone, without what a plugin prints
                opened.enter_context(redirect_stdout(sys.stderr))
            drive = Drive() if options.ros_drive else None
            receivers: list[Callable[[Tick], None]] = []
            if options.ros:
                from hsr8.cli.live_topics import live_topics  # noqa: PLC0415  with the exports

                topics = live_topics(options, scenario, path, drive, opened)
                receivers.append(topics.exchange)
            if not options.quiet:
                receivers.append(opened.enter_context(Progress(scenario.duration)).show)
            if pace := float(options.ros) if options.pace is None else options.pace:
                receivers.append(Pace(pace).wait)

            def on_tick(tick: Tick) -> None:
                for receive in receivers:
                    receive(tick)

            address = view.address if view else ""
            run = run_scenario(scenario, path, command, live=address, on_tick=on_tick, drive=drive)
        if run.diverged:
            print(f"hsr8: {run.diverged}", file=sys.stderr)
        if not (options.json or options.quiet):
            print("\n".join(report.lines(run, run.criteria, run.folder.parent)))
        failures = _write_outputs(options, run)
        if options.json:
            verdicts = {"criteria_met": run.criteria_met, "definitions": report.VERDICTS}
            failed = {"failed_outputs": [*map(str, failures)]}
            print(atomic.dumps(run.metrics | verdicts | failed))
        if view is not None and run.exit_reason != "interrupted":
            end = "Ctrl-C" if view.page else "closing the window"
            print(f"{end} ends the viewer", file=sys.stderr)
            view.wait()
    for failure in failures:
        print(f"hsr8: {failure}", file=sys.stderr)
    codes = [failure.exit_code for failure in failures]
    return max([exit_code(run.exit_reason, run.criteria), *codes])


def _write_outputs(options: Run, run: RecordedRun) -> list[Hsr8Error]:
    """Write log, bag and video into a run folder; return the errors of those that are missing."""
    writers = (options.log, _write_log), (options.bag, _write_bag), (options.video, _write_video)
    failures = []
    for write in [write for wanted, write in writers if wanted]:
        try:
            with crash_report(run.folder):
                write(run, options)
        except Hsr8Error as error:
            failures.append(error)
    return failures


def _write_log(run: RecordedRun, _: Run) -> None:
    # Imported late: runs without a log start 0.2 s earlier.
    from hsr8.show.log.run_log import write_log  # noqa: PLC0415

    write_log(run)


def _write_bag(run: RecordedRun, _: Run) -> None:
    from hsr8.cli.output_file import writing  # noqa: PLC0415
    from hsr8.export.bag import write_bag  # noqa: PLC0415

    with writing("--bag", run.folder / BAG), atomic.draft(run.folder / BAG) as folder:
        write_bag(run, folder)


def _write_video(run: RecordedRun, options: Run) -> None:
    """Draw the video, unless the run was interrupted or has no motion."""
    if run.exit_reason == "interrupted" or not run.metrics["sim_time_s"]:
        command = f"hsr8 render {shell_word(str(run.folder))}"
        time = run.metrics["sim_time_s"]
        print(f"no video: {run.exit_reason} at {time:g} s; {command}", file=sys.stderr)
        return
    # Imported late: runs without a video start 0.08 s earlier.
    from hsr8.cli.output_file import writing  # noqa: PLC0415
    from hsr8.cli.render import drawing  # noqa: PLC0415
    from hsr8.show.video.run_video import VideoOptions, render_run  # noqa: PLC0415

    file, silent = run.folder / VIDEO, options.quiet or options.json
    with writing("--video", file), drawing(Console(stderr=True, quiet=silent)) as show:
        render_run(run, VideoOptions(), file, show)
    if not silent:
        print(f"video       {file}")


@contextmanager
def _view(options: Run) -> "Iterator[LiveView | None]":
    """Start the viewer, if ``--view`` is given."""
    if options.view is None:
        yield None
        return
    from hsr8.show.viewer import live_view  # noqa: PLC0415

    with live_view(options.view) as view:
        if view.page:
            print(f"open in a browser on this machine:  {view.page}", file=sys.stderr)
        yield view
