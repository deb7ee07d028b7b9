"""``hsr8 replay``: the log of a run in the Rerun viewer."""

import shlex
import sys

from hsr8.cli.options import Replay
from hsr8.cli.output_file import parse_size, require_file_name, writing
from hsr8.errors import UsageError
from hsr8.recorder.files import atomic
from hsr8.recorder.run.manifest import versions
from hsr8.recorder.run.run_reader import Run, open_run
from hsr8.render import viewer


def main(options: Replay) -> int:
    """Open the viewer, or write a screenshot of it.

    Raises:
        UsageError: there is no such run or log, or no display.
    """
    run = open_run(options.run)
    if run.log_file is None:
        raise UsageError(f"{run.path}: no log; the run was made with --no-log")
    if options.screenshot is not None:
        require_file_name("--screenshot", options.screenshot, (".png",))
        size = parse_size(options.size)
        time = _time(options, run)
        print("drawing in the viewer, which takes some ten seconds", file=sys.stderr, flush=True)
        image = viewer.screenshot(run.log_file, time, size)
        with writing("--screenshot", options.screenshot):
            options.screenshot.write_bytes(image)
        if options.json:
            print(atomic.dumps({"screenshot": str(options.screenshot), "time_s": time}))
        else:
            print(f"screenshot  {options.screenshot} (at {time:.1f} s)")
        return 0
    if not viewer.has_display():
        run_word, log_word = shlex.quote(str(run.path)), shlex.quote(str(run.log_file))
        version = versions()["rerun-sdk"]
        raise UsageError(
            "no display for the viewer"
            f"\n  screenshot:          hsr8 replay {run_word} --screenshot log.png"
            f"\n  on another machine:  copy {log_word}, then"
            f"\n                       pip install rerun-sdk=={version} && rerun log.rrd"
        )
    code = viewer.show(run.log_file)
    if code != 0:
        raise UsageError(f"the Rerun viewer ended with status {code}; try --screenshot PNG")
    return 0


def _time(options: Replay, run: Run) -> float:
    """Return the simulated time of the screenshot [s]: by default the middle of the run."""
    time = run.records["time"]
    if options.time is None:
        return float(time[len(time) // 2]) if len(time) else 0.0
    end = float(time[-1]) if len(time) else 0.0
    if not 0.0 <= options.time <= end:
        raise UsageError(f"--time: not in the run, got {options.time:g}; expected 0 to {end:g} s")
    return options.time
