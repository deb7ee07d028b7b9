"""Kill runs at random times; the remaining folders must be readable and nearly complete.

python scripts/kill_study.py --kills 50 --out docs/results/kill.md
"""

import argparse
import mmap
import random
import struct
import subprocess
import sys
import tempfile
import time as clock
from pathlib import Path

from hsr8.evaluation.sweep.definition import Definition
from hsr8.recorder.rows import TABLES
from hsr8.recorder.run.run import Run
from hsr8.recorder.run.run_reader import open_run
from hsr8.scenario.loader import dump, load_scenario
from walking.parameters import CONTROL_PERIOD

from study_page import command_line

LIGHT = ("--body", "kinematic", "--camera", "analytic")
SHOWN = ("ticks", "records", "frames")
TICK = struct.Struct("<q")
# Runs the command line and stores the number of recorded ticks in a file that outlives the kill.
RUN = """
import mmap, struct, sys
from hsr8.cli.main import entry
from hsr8.recorder.recorder import Recorder

with open(sys.argv[1], "r+b") as file:
    ticks = mmap.mmap(file.fileno(), 8)
append = Recorder.append
def counted(recorder, tick):
    ticks[:] = struct.pack("<q", tick.number + 1)
    append(recorder, tick)
Recorder.append = counted
entry(sys.argv[2:])
"""


def killed(folder: Path, words: list[str], delay: float) -> tuple[Run, float]:
    """Kill a run `delay` seconds of wall time after its first tick.

    Returns:
        The run and the simulated time of the kill [s].
    """
    counter = folder / "ticks"
    counter.write_bytes(bytes(TICK.size))
    with counter.open("r+b") as file, mmap.mmap(file.fileno(), TICK.size) as ticks:
        process = subprocess.Popen([sys.executable, "-c", RUN, str(counter), *words])
        while process.poll() is None and not any(ticks[:]):
            clock.sleep(0.01)
        clock.sleep(delay)
        if process.poll() is not None:
            raise SystemExit("the run ended before the kill")
        process.kill()
        process.wait()
        (count,) = TICK.unpack(ticks[:])
    return open_run(folder), count * CONTROL_PERIOD


def losses(run: Run, end: float) -> dict[str, float]:
    """Return the time from the last row of every table to the `end` of the run [s].

    Raises:
        UsageError: a table is not readable.
    """
    lost = {}
    for name in TABLES:
        time = getattr(run, name)["time"].tolist()
        period = time[-1] - time[-2] if len(time) > 1 else 0.0
        lost[name] = max(0.0, end - (time[-1] + period if time else 0.0))
    return lost


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--full", type=int, default=5, help="number of runs in full physics")
    parser.add_argument("--longest", type=float, default=3.0, help="wall time to a kill [s]")
    parser.add_argument("--seed", type=int, default=1000, help="of the first run")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    options = parser.parse_args()
    draw, rows, readable, most = random.Random(options.seed), [], 0, 0.0
    for k in range(options.kills):
        seed, full = options.seed + k, k < options.full
        with tempfile.TemporaryDirectory() as name:
            words = ["run", "course", "--seed", str(seed), "--quiet", "--out", name]
            words += () if full else LIGHT
            run, end = killed(Path(name), words, draw.uniform(0.0, options.longest))
            try:
                lost = losses(run, end)
                readable += 1
                most = max([most, *(lost[table] for table in SHOWN)])
                cells = ["yes", *(f"{lost[table]:.2f}" for table in SHOWN)]
            except Exception as error:  # reported in the table
                cells = [f"NO: {error}", *("" for _ in SHOWN)]
        body = "full, rendered" if full else "kinematic, analytic"
        rows.append(f"| {seed} | {body} | {end:.2f} | {' | '.join(cells)} |")
        print(rows[-1], flush=True)
    versions = Definition.now("course", (), dump(load_scenario("course"))).made_with()
    head = f"| seed | body, camera | killed at [s] | readable | {' | '.join(SHOWN)} |"
    lines = ["# Runs killed at random times", "", f"    {command_line()}", "", f"{versions}.", ""]
    lines += ["`course` with log, killed by SIGKILL at a random time. The last columns are the"]
    lines += ["simulated time from the end of a table to the kill [s].", ""]
    lines += [f"**{readable} of {len(rows)} folders readable, at most {most:.2f} s lost.**", ""]
    lines += [head, "|---" * (4 + len(SHOWN)) + "|", *rows, ""]
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text("\n".join(lines))


if __name__ == "__main__":
    main()
