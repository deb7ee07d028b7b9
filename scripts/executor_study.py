"""Run the same seeds serially and by every executor that is installed; compare ends and times.

    python scripts/executor_study.py --seeds 1000:1012 --write

Dask and Ray are extras: `pip install "hsr8[dask]" "hsr8[ray]"`.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path

from hsr8.evaluation.sweep.folder import SweepFolder

from study_page import RESULTS, command_line

PAGE = RESULTS / "executors.md"
EXTRAS = {"dask": "distributed", "ray": "ray"}


def sweep(
    options: argparse.Namespace, executor: str, workers: int, out: Path
) -> tuple[float, SweepFolder]:
    """Wall time of a sweep [s], and its folder."""
    words = [sys.executable, "-m", "hsr8", "sweep", options.scenario, "--seeds", options.seeds]
    words += ["--workers", str(workers), "--executor", executor, "--out", str(out), "--quiet"]
    words += ["--body", options.body, "--camera", options.camera, "--keep", "none"]
    began = time.perf_counter()
    code = subprocess.run(words, check=False).returncode
    wall = time.perf_counter() - began
    if code not in (0, 1):
        raise SystemExit(f"{executor}: the sweep ended with exit code {code}")
    return wall, SweepFolder.read(out)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="quick")
    parser.add_argument("--seeds", default="1000:1012", help="A:B for A to B-1")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--body", default="kinematic", choices=("full", "kinematic"))
    parser.add_argument("--camera", default="analytic", choices=("rendered", "analytic"))
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name}")
    options = parser.parse_args()
    tried = [("local", 1), ("local", options.workers)]
    tried += [(name, options.workers) for name, module in EXTRAS.items() if find_spec(module)]
    load = os.getloadavg()[0]
    lines = ["| executor | workers | wall [s] | against serial | same ends |", "|---" * 5 + "|"]
    with tempfile.TemporaryDirectory() as folder:
        serial, ends = 0.0, []
        for number, (name, workers) in enumerate(tried):
            wall, found = sweep(options, name, workers, Path(folder) / str(number))
            hashes = [row.get("state_hash") for row in found.rows()]
            if not ends:
                serial, ends = wall, hashes
            same = sum(a == b for a, b in zip(hashes, ends, strict=True))
            cells = (f"`{name}`", workers, f"{wall:.1f}", f"{serial / wall:.2f}")
            lines.append(f"| {' | '.join(map(str, cells))} | {same} of {len(ends)} |")
            print(lines[-1], flush=True)
        made_with = found.definition.made_with()
    if options.write:
        text = [
            "# Executors of sweeps",
            "",
            f"    {command_line()}",
            "",
            f"{made_with}; {os.cpu_count()} cores, load {load:.1f} before.",
            "",
            f"`{options.scenario}`, {options.body} body, {options.camera} camera. The wall time "
            "of a sweep counts everything: imports, the start of the cluster, each run's process.",
            "",
            *lines,
        ]
        PAGE.write_text("\n".join(text) + "\n")


if __name__ == "__main__":
    main()
