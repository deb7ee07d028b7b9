"""Kill runs at random times; the remaining folders must be readable and nearly complete.

python scripts/kill_study.py --kills 50 --out docs/results/kill.md
"""

import argparse
import random
import subprocess
import sys
import tempfile
import time as clock
import warnings
from pathlib import Path

from hsr8.evaluation.sweep.definition import Definition
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.run_reader import Run, open_run
from hsr8.recorder.run.tape import read_tape
from hsr8.scenario.loader import dump, load_scenario
from walking.parameters import CONTROL_PERIOD

from study_page import command_line

LIGHT = ("--body", "kinematic", "--camera", "analytic")
FILES = ("log", "motion", "walking", "tape")


def killed(out: Path, words: list[str], delay: float) -> Run:
    """Kill a run `delay` seconds of wall time after its first record."""
    process = subprocess.Popen([sys.executable, "-m", "hsr8", "run", "quick", *words])
    while process.poll() is None and not any(out.glob(f"*/*/{run_folder.TRAJECTORY}")):
        clock.sleep(0.01)
    clock.sleep(delay)
    process.kill()
    process.wait()
    return open_run(out)


def ends(run: Run) -> dict[str, float]:
    """Return the last simulated time in every file [s].

    Raises:
        Exception: a file is not readable.
    """
    run.frame_summaries(), run.event_lines()
    readers = (_log_end, _motion_end, _walking_end, _tape_end)
    return dict(zip(FILES, (reader(run) for reader in readers), strict=True))


def _motion_end(run: Run) -> float:
    return float(run.trajectory().time[-1])


def _walking_end(run: Run) -> float:
    return float(run.walking().time[-1])


def _tape_end(run: Run) -> float:
    """Return the end of the last complete second of the tape [s]."""
    block = read_tape(run.path / run_folder.TAPE, whole=False)[-1]
    return (block.tick + len(block.setpoints)) * CONTROL_PERIOD


def _log_end(run: Run) -> float:
    from rerun.chunk import RrdReader  # noqa: PLC0415  takes seconds

    last = 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a killed run has no footer
        for chunk in RrdReader(str(run.path / run_folder.LOG)).stream():
            batch = chunk.to_record_batch()
            if "sim_time" in batch.schema.names and batch.num_rows:
                last = max(
                    last, *(t / 1e9 for t in batch.column("sim_time").cast("int64").to_pylist())
                )
    return last


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--full", type=int, default=5, help="number of runs in full physics")
    parser.add_argument("--duration", type=float, default=30.0, help="simulated time of a run [s]")
    parser.add_argument("--seed", type=int, default=1000, help="of the first run")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    options = parser.parse_args()
    draw, rows, readable = random.Random(options.seed), [], 0
    for k in range(options.kills):
        seed, full = options.seed + k, k < options.full
        with tempfile.TemporaryDirectory() as name:
            words = ["--seed", str(seed), "--duration", str(options.duration), "--quiet"]
            words += [*(() if full else LIGHT), "--out", name]
            run = killed(Path(name), words, draw.uniform(0.0, 3.0))
            try:
                last = ends(run)
                readable += 1
                cells = [f"{max(last.values()):.2f}", "yes"]
                cells += [f"{max(last.values()) - end:.2f}" for end in last.values()]
            except Exception as error:  # reported in the table
                cells = ["", f"NO: {error}", *FILES]
        body = "full, rendered" if full else "kinematic, analytic"
        rows.append(f"| {seed} | {body} | {' | '.join(cells)} |")
        print(rows[-1], flush=True)
    versions = Definition.now("quick", (), dump(load_scenario("quick"))).made_with()
    head = f"| seed | body, camera | killed at [s] | readable | {' | '.join(FILES)} |"
    lines = ["# Runs killed at random times", "", f"    {command_line()}", "", f"{versions}.", ""]
    lines += ["`quick` with log, killed by SIGKILL at a random time. The last columns are the time"]
    lines += ["from the last row of a file to the last row of all files [s].", ""]
    lines += [f"{readable} of {len(rows)} folders readable.", "", head, "|---" * 8 + "|", *rows, ""]
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text("\n".join(lines))


if __name__ == "__main__":
    main()
