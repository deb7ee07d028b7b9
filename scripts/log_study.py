"""What the Rerun log of a run costs at each level: time and room.

    python scripts/log_study.py --scenario course --write

Processor time, which other work on the machine hardly changes; that of the log is without what
Rerun's own threads do beside it.
"""

import argparse
import tempfile
from pathlib import Path
from time import process_time

from hsr8.gl import require_gl
from hsr8.loop import Simulation
from hsr8.recorder.log.rerun_log import RerunLog
from hsr8.recorder.log_level import LogLevel
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario

from stopwatch import Stopwatch
from study_page import RESULTS, command_line, environment

PAGE = RESULTS / "log.md"
SHARE, SIZE = 0.10, 15.0  # what the standard level may take: of the time, and [MB/min]


def row(scenario: Scenario, level: LogLevel | None) -> tuple[str, str]:
    """One run: its row of the table, and the hash of its end."""
    with tempfile.TemporaryDirectory() as folder, Stopwatch() as watch:
        simulation = Simulation(scenario, scenario.seed)
        file = Path(folder) / "log.rrd"
        size = (scenario.camera.width, scenario.camera.height)
        if level is not None:
            gaze = scenario.navigation.gaze
            log = RerunLog(
                file, simulation.model, simulation.layout, size, "study", gaze=gaze, level=level
            )
            simulation.listeners.append(log)
            for method in ("on_record", "on_event", "close"):
                watch.watch(RerunLog, method, "log")
        started = process_time()
        outcome = simulation.run()
        total, spent = process_time() - started, watch.total("log")
        megabytes = file.stat().st_size / 1e6 if file.exists() else 0.0
    per_second = 1e3 / outcome.time
    cells = (
        level or "none",
        f"{per_second * total:.0f}",
        f"{per_second * spent:.1f}",
        f"{100.0 * spent / total:.1f}",
        f"{60.0 * megabytes / outcome.time:.1f}",
    )
    return f"| {' | '.join(cells)} |", outcome.state_hash


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--seed", type=int, default=1000)
    parser.add_argument("--duration", type=float, default=30.0, help="simulated [s]")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name}")
    options = parser.parse_args()
    scenario = load_scenario(options.scenario, [f"duration={options.duration:g}"], options.seed)
    lines = [
        "| level | whole loop [ms/s] | log [ms/s] | share [%] | log [MB/min] |",
        "|---|---|---|---|---|",
    ]
    hashes = set()
    for level in (None, *LogLevel):
        line, state = row(scenario, level)
        print(line, flush=True)
        lines.append(line)
        hashes.add(state)
    same = "the same, bit for bit" if len(hashes) == 1 else "NOT the same"
    if options.write:
        text = [
            "# Cost of the Rerun log",
            "",
            f"{environment(('hsr8', 'mujoco', 'rerun-sdk'))}, {require_gl()}.",
            "",
            f"    {command_line()}",
            "",
            f"`{options.scenario}`, seed {scenario.seed}, {options.duration:g} s: full physics and",
            "rendered camera unless the scenario says otherwise. Processor time of all threads per",
            "simulated second; the log's holds what Rerun's own threads do meanwhile. The level",
            f"`standard` is to stay below {100.0 * SHARE:.0f} % and {SIZE:g} MB/min.",
            f"The end of the four runs is {same}.",
            "",
            *lines,
        ]
        PAGE.write_text("\n".join(text) + "\n")


if __name__ == "__main__":
    main()
