"""Run the same seeds with and without the log and compare the hashes of the final state.

python scripts/determinism_study.py --seeds 1000-1004 --out docs/results/determinism.md
"""

import argparse
import sys
from pathlib import Path

from run_study import environment, run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--seeds", default="1000-1004", help="first-last, both included")
    parser.add_argument("--duration", default="60", help="simulated time [s]")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    arguments = parser.parse_args()
    first, last = (int(part) for part in arguments.seeds.split("-"))
    limit = ["--duration", arguments.duration]
    lines = [
        "# Same seed, same end",
        "",
        f"    python scripts/determinism_study.py {' '.join(sys.argv[1:])}",
        "",
        environment(),
        "",
        f"`{arguments.scenario}`, full physics and rendered camera, {arguments.duration} s.",
        "",
        "| seed | with log | without log | equal |",
        "|---|---|---|---|",
    ]
    for seed in range(first, last + 1):
        logged = run(arguments.scenario, seed, limit)["state_hash"]
        bare = run(arguments.scenario, seed, [*limit, "--no-log"])["state_hash"]
        equal = "yes" if logged == bare else "NO"
        lines.append(f"| {seed} | `{logged[:16]}` | `{bare[:16]}` | {equal} |")
        print(lines[-1], flush=True)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
