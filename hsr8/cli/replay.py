"""``hsr8 replay``: the log of a run in the Rerun viewer."""

import sys
from pathlib import Path

from hsr8.cli.options import Replay
from hsr8.cli.output_file import parse_size, require_file_name, writing
from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.files.text import shell_word
from hsr8.recording.manifest import versions
from hsr8.recording.run import Run, open_run
from hsr8.show import viewer
from hsr8.show.viewer import live_view


def main(options: Replay) -> int:
    """Open the viewer, or write a screenshot of it."""
    run = open_run(options.run)
    log = (None if options.full else run.log_file) or _made(run, full=options.full)
    if options.screenshot is not None:
        require_file_name("--screenshot", options.screenshot, (".png",))
        size = parse_size(options.size)
        time = _time(options, run)
        print("drawing in the viewer, which takes some ten seconds", file=sys.stderr, flush=True)
        image = viewer.screenshot(log, time, size)
        with writing("--screenshot", options.screenshot):
            atomic.write_bytes(options.screenshot, image)
        if options.json:
            print(atomic.dumps({"screenshot": str(options.screenshot), "time_s": time}))
        else:
            print(f"screenshot  {options.screenshot} (at {time:.1f} s)")
        return 0
    if options.view == "web":
        with live_view("web", log) as view:
            print(f"open in a browser on this machine:  {view.page}", flush=True)
            print("Ctrl-C ends the viewer", file=sys.stderr)
            view.wait()
        return 0
    if not viewer.has_display():
        run_word, log_word = shell_word(str(run.folder)), shell_word(str(log))
        version = versions()["rerun-sdk"]
        raise UsageError(
            "no display for the viewer"
            f"\n  in a browser:        hsr8 replay {run_word} --view web"
            f"\n  screenshot:          hsr8 replay {run_word} --screenshot log.png"
            f"\n  on another machine:  copy {log_word}, then"
            f"\n                       pip install rerun-sdk=={version} && rerun log.rrd"
        )
    code = viewer.show(log)
    if code != 0:
        raise UsageError(f"the Rerun viewer ended with status {code}; try --screenshot PNG")
    return 0


def _made(run: Run, *, full: bool) -> Path:
    """Write the log of a run that has none."""
    run.scenario()  # reports a scenario that cannot be read
    print("writing the log", file=sys.stderr, flush=True)
    from hsr8.show.log.run_log import write_log  # noqa: PLC0415  takes seconds

    return write_log(run, full=full)


def _time(options: Replay, run: Run) -> float:
    """Return the simulated time of the screenshot [s]: by default the middle of the run."""
    time = run.records["time"]
    if options.time is None:
        return float(time[len(time) // 2]) if len(time) else 0.0
    end = float(time[-1]) if len(time) else 0.0
    if not 0.0 <= options.time <= end:
        raise UsageError(f"--time: not in the run, got {options.time:g}; expected 0 to {end:g} s")
    return options.time
