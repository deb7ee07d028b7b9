"""Compare gazes and settings in the 2-D loop of the decision study, seed by seed.

    python scripts/gaze_study.py fast --seeds 1000-1019 --out docs/results/gaze.md

Every arm walks the same worlds; the first one is what all others are compared with, by an
exact McNemar test over the seeds that both have walked. Rows are kept as JSON lines next to
the page, and a study that is started again goes on where it stopped.
"""

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

from hsr8.evaluation.proportion import Proportion
from hsr8.scenario.loader import load_scenario

import numpy as np
from decision_study import Run
from scipy.stats import binomtest
from study_page import add_seeds, command_line, environment

SWEEP = (
    "navigation.gaze.mode=sweep navigation.gaze.sweep_period={} navigation.gaze.sweep_amplitude={}"
)
GAZES = {
    "deadline": "",
    "integrated": "navigation.gaze.mode=integrated",
    "sweep": "navigation.gaze.mode=sweep",
    "info": "navigation.gaze.mode=info",
    "psi-ob": "navigation.gaze.mode=psi-ob",
    "psi-lm": "navigation.gaze.mode=psi-lm",
    "psi-sf": "navigation.gaze.mode=psi-sf",
    "psi-way": "navigation.gaze.mode=psi-way",
    "fixed": "navigation.gaze.mode=fixed",
    "omnidirectional": "camera.source=omnidirectional",
}
SWEEPS = {
    f"{period:g} s, {amplitude:g} rad": SWEEP.format(period, amplitude)
    for period, amplitude in ((1.5, 1.2), (2.0, 0.8), (2.0, 1.2), (3.0, 1.2), (4.0, 1.2))
}
TABLES = {"gazes": GAZES, "sweeps": SWEEPS}


def walk(scenario: str, arm: str, settings: Sequence[str], seed: int) -> dict[str, object]:
    """One run as a row."""
    episode = Run(load_scenario(scenario, settings, seed), seed, "camera").run()
    return {"scenario": scenario, "arm": arm, **vars(episode)}


def table(rows: list[dict], arms: Sequence[str]) -> list[str]:
    """Markdown of all arms."""
    good = {arm: {r["seed"]: bool(r["success"]) for r in rows if r["arm"] == arm} for arm in arms}
    lines = [
        "| arm | N | success [95 %] | contacts: movers, static | timeouts | median time [s] "
        "| mover near [% of time] | head [rad/s] | first only / this only | p |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for arm in arms:
        mine = [r for r in rows if r["arm"] == arm]
        if not mine:
            continue
        n, k = len(mine), sum(good[arm].values())
        interval = Proportion.counted(k, n)
        hit = [bool(r["cause"].get("moving")) for r in mine if r["reason"] == "contact"]
        total = sum(r["time"] for r in mine)
        both = good[arm].keys() & good[arms[0]].keys()
        theirs = sum(good[arms[0]][s] and not good[arm][s] for s in both)
        ours = sum(good[arm][s] and not good[arms[0]][s] for s in both)
        p = binomtest(ours, ours + theirs).pvalue if ours + theirs else 1.0
        done = [r["time"] for r in mine if r["success"]]
        lines.append(
            f"| {arm} | {n} | {100 * k / n:.0f} % "
            f"[{100 * interval.low:.0f}, {100 * interval.high:.0f}] "
            f"| {sum(hit)}, {len(hit) - sum(hit)} | {sum(r['reason'] == 'timeout' for r in mine)} "
            f"| {np.median(done) if done else float('nan'):.0f} "
            f"| {100 * sum(r['close'] for r in mine) / total:.1f} "
            f"| {sum(r['travel'] for r in mine) / total:.2f} "
            + ("| | |" if arm == arms[0] else f"| {theirs} / {ours} | {p:.2g} |")
        )
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario")
    add_seeds(parser, range(10))
    parser.add_argument("--table", choices=sorted(TABLES), default="gazes")
    parser.add_argument("--arm", nargs="*", default=[], help="more arms: name:key=value,key=value")
    parser.add_argument("--only", nargs="*", help="of the table's arms only these")
    parser.add_argument("--set", nargs="*", default=[], help="settings of all arms, key=value")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    arguments = parser.parse_args()
    arms = {k: v.split() for k, v in TABLES[arguments.table].items()}
    if arguments.only is not None:
        arms = {k: arms[k] for k in arguments.only}
    for arm in arguments.arm:
        name, _, text = arm.partition(":")
        arms[name] = [part for part in text.split(",") if part]
    raw = arguments.out.with_suffix(".jsonl")
    rows = [json.loads(line) for line in raw.read_text().splitlines()] if raw.exists() else []
    known = {(r["arm"], r["seed"]) for r in rows}
    first, last = arguments.seeds[0], arguments.seeds[-1]
    head = [
        f"# Gazes in `{arguments.scenario}`, 2-D loop, seeds {first} to {last}",
        "",
        f"    {command_line()}",
        "",
        f"{environment(('hsr8', 'numpy', 'scipy'))}.",
        "",
    ]
    for seed in arguments.seeds:
        for arm, settings in arms.items():
            if (arm, seed) in known:
                continue
            row = walk(arguments.scenario, arm, [*arguments.set, *settings], seed)
            rows.append(json.loads(json.dumps(row, default=str)))
            with raw.open("a") as file:
                file.write(json.dumps(rows[-1]) + "\n")
            arguments.out.write_text("\n".join([*head, *table(rows, list(arms)), ""]))


if __name__ == "__main__":
    main()
