"""Run the same seeds with and without the log and compare the hashes of the final state.

python scripts/determinism_study.py --seeds 1000:1005 --out docs/results/determinism.md
"""

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from hsr8.evaluation.sweep.definition import Definition
from hsr8.evaluation.sweep.job import Job, run_job
from hsr8.evaluation.sweep.seeds import parse_seeds
from hsr8.scenario.loader import dump, load


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--seeds", default="1000:1005", help="A:B for A to B-1, or a list")
    parser.add_argument("--duration", default="60", help="simulated time [s]")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    arguments = parser.parse_args()
    scenario = dump(load(arguments.scenario, [f"duration={arguments.duration}"]))
    made_with = Definition.now(arguments.scenario, (), scenario).made_with()
    lines = [
        "# Same seed, same end",
        "",
        f"    python scripts/determinism_study.py {' '.join(sys.argv[1:])}",
        "",
        f"{made_with}.",
        "",
        f"`{arguments.scenario}`, full physics and rendered camera, {arguments.duration} s.",
        "",
        "| seed | with log | without log | equal |",
        "|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as folder:
        for seed in parse_seeds(arguments.seeds):
            job = Job(seed, folder, scenario, timeout=7200.0, keep="none")
            logged, bare = (
                run_job(replace(job, log=log)).get("state_hash", "crashed") for log in (True, False)
            )
            equal = "yes" if logged == bare else "NO"
            lines.append(f"| {seed} | `{logged[:16]}` | `{bare[:16]}` | {equal} |")
            print(lines[-1], flush=True)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
