"""Run a scenario over many seeds and write the table of results.

    python scripts/run_study.py course --seeds 1000-1019 --out docs/results/course.md

Each run is a process of its own (``hsr8 run ... --json``), so a crash of one is a row of
the table and not the end of the study. The raw rows go beside the table as JSON lines.
"""

import argparse
import json
import platform
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path
from statistics import median

from wilson import wilson

COLUMNS = {
    "success": "success",
    "falls": "falls",
    "collisions": "contacts",
    "collisions_closing": "closing",
    "via_points_passed": "via points",
    "arrival_error_deg": "arrival error [deg]",
    "time_to_goal_s": "time to goal [s]",
    "min_clearance_m": "least clearance [m]",
    "localization_rmse_m": "position RMSE [m]",
    "heading_rmse_deg": "heading RMSE [deg]",
    "nees_mean": "NEES/3",
    "real_time_factor": "real-time factor",
    "exit_reason": "ended by",
}


def run(scenario: str, seed: int, extra: list[str]) -> dict:
    """One run; a crash becomes a row that says so."""
    command = [
        sys.executable,
        "-m",
        "hsr8",
        "run",
        scenario,
        "--seed",
        str(seed),
        "--json",
        "--quiet",
    ]
    done = subprocess.run([*command, *extra], capture_output=True, text=True, check=False)
    lines = done.stdout.strip().splitlines()
    if not lines:
        return {"exit_reason": f"crashed ({done.returncode})", "error": done.stderr[-2000:]}
    return json.loads(lines[-1])


def environment() -> str:
    """What the results were computed with."""
    versions = ", ".join(f"{p} {version(p)}" for p in ("hsr8", "mujoco", "numpy", "rerun-sdk"))
    return f"{versions}; Python {platform.python_version()}, {platform.machine()}, software OpenGL."


def show(value: object) -> str:
    """A cell of the table."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def table(scenario: str, rows: dict[int, dict], command: str) -> str:
    """Markdown of all rows and their summary."""
    n = len(rows)
    succeeded = sum(bool(r.get("success")) for r in rows.values())
    upright = sum(r.get("falls") == 0 for r in rows.values())
    low, high = wilson(succeeded, n)
    falls_low, falls_high = wilson(upright, n)
    factors = [r["real_time_factor"] for r in rows.values() if "real_time_factor" in r]
    lines = [
        f"# `{scenario}`: {n} seeds, {min(rows)} to {max(rows)}",
        "",
        f"    {command}",
        "",
        environment(),
        "",
        f"- success: {succeeded} of {n} (95 % interval {low:.0%} to {high:.0%})",
        f"- without a fall: {upright} of {n} ({falls_low:.0%} to {falls_high:.0%})",
        f"- contacts: {sum(r.get('collisions', 0) for r in rows.values())} in all, "
        f"{sum(r.get('collisions_closing', 0) for r in rows.values())} of them closed by the robot",
    ]
    if factors:
        lines.append(f"- real-time factor: median {median(factors):.2f}")
    lines += [
        "",
        "| seed | " + " | ".join(COLUMNS.values()) + " |",
        "|---" * (len(COLUMNS) + 1) + "|",
    ]
    for seed, row in sorted(rows.items()):
        cells = [show(row.get(key, "")) for key in COLUMNS]
        lines.append(f"| {seed} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario")
    parser.add_argument("--seeds", default="1000-1019", help="first-last, both included")
    parser.add_argument("--workers", type=int, default=1, help="runs at a time")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    arguments, extra = parser.parse_known_args()
    first, last = (int(part) for part in arguments.seeds.split("-"))
    rows: dict[int, dict] = {}
    with ThreadPoolExecutor(arguments.workers) as pool:
        seeds = range(first, last + 1)
        results = pool.map(lambda seed: run(arguments.scenario, seed, extra), seeds)
        for seed, row in zip(seeds, results, strict=True):
            rows[seed] = row
            print(seed, {k: show(row.get(k, "")) for k in COLUMNS}, flush=True)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    command = shlex.join(["python", "scripts/run_study.py", *sys.argv[1:]])
    arguments.out.write_text(table(arguments.scenario, rows, command))
    raw = arguments.out.with_suffix(".jsonl")
    raw.write_text("".join(json.dumps({"seed": s} | r) + "\n" for s, r in sorted(rows.items())))


if __name__ == "__main__":
    main()
