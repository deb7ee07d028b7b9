"""Compare gazes on the same worlds, seed by seed.

    python scripts/gaze_study.py behind crowd --table gazes --seeds 0:30 --out gaze.md
    python scripts/gaze_study.py course --exact --table paper --seeds 0:30 --out paper.md

Every arm walks the same worlds until the goal, the first contact or the time limit. The first arm
is compared with all others: successes by an exact McNemar test, successes weighted by the
shortest time over the time (SPT) by a Wilcoxon test. Rows are appended to a JSON Lines file next
to the page, and a study that is started again continues. Several processes may share the file,
each with its own ``--shard I/N``.
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from hsr8.errors import ScenarioError
from hsr8.evaluation.efficiency import spl
from hsr8.evaluation.paired import compare_successes, compare_values
from hsr8.evaluation.proportion import Proportion
from hsr8.loop import Simulation
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.world.field.generator import draw_world

import numpy as np
from fast_loop import FastRun
from gaze_arms import CAMERAS, TABLES
from study_page import STAND_INS, add_seeds, command_line, environment

Row = dict[str, object]


def walk(scenario: Scenario, seed: int, *, fast: bool, exact: bool) -> Row:
    """Return success, contact, time [s], head travel [rad/s] and sharp fraction of one run."""
    if fast:
        return vars(FastRun(scenario, seed, exact=exact).run())
    contact, pan, travel, frames, sharp = "", None, 0.0, 0, 0
    with Simulation(scenario, seed) as simulation:
        for tick in simulation:
            if tick.record is None:
                continue
            if tick.record.truth.contacts:
                contact = "mover" if tick.record.truth.contacts[0].moving else "static"
                simulation.interrupt()
            if tick.record.frame is not None:
                view = tick.record.frame.measured.view
                travel += 0.0 if pan is None else abs(view.pan - pan)
                pan, frames, sharp = view.pan, frames + 1, sharp + (not view.blind)
    return {
        "success": simulation.exit_reason == "goal" and not contact,
        "contact": contact or ("fall" if simulation.exit_reason == "fall" else ""),
        "time": round(simulation.time, 2),
        "head_travel": round(travel / max(simulation.time, 0.1), 3),
        "sharp": round(sharp / max(1, frames), 3),
    }


def shortest_time(scenario: Scenario, seed: int) -> float:
    """Return the time of the feasibility certificate [s]."""
    return draw_world(scenario, seed).certificate.time


def table(rows: Sequence[Row], arms: Sequence[str], families: Sequence[str]) -> Iterator[str]:
    """Yield the lines of a table: all arms on the worlds that all of them walked."""
    done: dict[str, dict[tuple[str, int], Row]] = {arm: {} for arm in arms}
    for row in rows:
        if row["arm"] in done and row["family"] in families:
            done[str(row["arm"])][str(row["family"]), int(str(row["seed"]))] = row
    done = {arm: runs for arm, runs in done.items() if runs}
    worlds = sorted(set.intersection(*(set(runs) for runs in done.values())))
    yield (
        "| arm | "
        + " | ".join(f"`{family}`" for family in families)
        + " | together [95 %] | difference [points] | SPT [%] | difference [points] "
        "| contacts: movers, static | timeouts | median time [s] | head [rad/s] "
        "| sharp frames [%] |"
    )
    yield "|" + "---|" * (len(families) + 10)
    first: Mapping[tuple[str, int], Row] | None = None
    for arm, runs in done.items():
        first = first or runs
        yield _line(arm, [runs[w] for w in worlds], [first[w] for w in worlds], families)


def _line(arm: str, runs: Sequence[Row], first: Sequence[Row], families: Sequence[str]) -> str:
    good = [bool(run["success"]) for run in runs]
    cells = []
    for family in families:
        mine = [bool(run["success"]) for run in runs if run["family"] == family]
        cells.append(f"{sum(mine)} of {len(mine)}")
    weighted, theirs = weights(runs), weights(first)
    p = ps = ""
    if runs is not first and list(runs) != list(first):
        p = compare_successes([bool(run["success"]) for run in first], good).points()
        ps = compare_values(theirs, weighted).points()
    contacts = [run["contact"] for run in runs]
    times = [float(str(run["time"])) for run in runs if run["success"]]
    cells += [
        str(Proportion.counted(sum(good), len(good))).split(", ")[1],
        p,
        f"{100.0 * weighted.mean():.1f}",
        ps,
        f"{contacts.count('mover')}, {contacts.count('static')}",
        str(sum(not run["success"] and not run["contact"] for run in runs)),
        f"{np.median(times):.0f}" if times else "",
        f"{np.mean([float(str(run['head_travel'])) for run in runs]):.2f}",
        f"{100.0 * np.mean([float(str(run['sharp'])) for run in runs]):.0f}",
    ]
    return f"| {arm} | " + " | ".join(cells) + " |"


def weights(runs: Sequence[Row]) -> np.ndarray:
    """Return success times shortest time over time of every run (n,) [1]."""
    times = [(float(str(r["shortest"])), float(str(r["time"]))) for r in runs]
    return np.array([spl(bool(r["success"]), *pair) for r, pair in zip(runs, times, strict=True)])


def settings_of(arguments: argparse.Namespace, arm: Sequence[str]) -> list[str]:
    """Return the settings of an arm, those of the arm last."""
    stand_ins = () if arguments.loop == "full" else STAND_INS
    return [*stand_ins, *CAMERAS[arguments.camera], *arguments.set, *arm]


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("families", nargs="+")
    add_seeds(parser, range(10))
    parser.add_argument("--loop", choices=("fast", "kinematic", "full"), default="fast")
    parser.add_argument("--exact", action="store_true", help="perfect sensing, fast loop only")
    parser.add_argument("--camera", choices=sorted(CAMERAS), default="realistic")
    parser.add_argument("--table", choices=sorted(TABLES), default="gazes")
    parser.add_argument("--only", nargs="*", help="of the table's arms only these")
    parser.add_argument("--arm", nargs="*", default=[], help="more arms: NAME:KEY=VALUE,KEY=VALUE")
    parser.add_argument("--set", nargs="*", default=[], help="settings of all arms, KEY=VALUE")
    parser.add_argument("--shard", default="0/1", help="run part I of N of the seeds")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    return parser.parse_args()


def main() -> None:
    arguments = parse()
    arms = {name: text.split() for name, text in TABLES[arguments.table].items()}
    if arguments.only is not None:
        arms = {name: arms[name] for name in arguments.only}
    for word in arguments.arm:
        name, _, text = word.partition(":")
        arms[name] = [part for part in text.split(",") if part]
    raw = arguments.out.with_suffix(".jsonl")
    known = {(r["arm"], r["family"], r["seed"]) for r in read(raw)}
    part, parts = map(int, arguments.shard.split("/"))
    for seed in arguments.seeds[part::parts]:
        for family in arguments.families:
            for arm, settings in arms.items():
                if (arm, family, seed) in known:
                    continue
                row = run_arm(arguments, settings, family, seed)
                if row is not None:
                    with raw.open("a") as file:
                        file.write(json.dumps({"arm": arm, **row}) + "\n")
        head = [f"    {command_line()}", "", f"{environment(('hsr8', 'numpy', 'scipy'))}.", ""]
        lines = table(read(raw), list(arms), arguments.families)
        arguments.out.write_text("\n".join([*head, *lines, ""]))


def run_arm(
    arguments: argparse.Namespace, settings: Sequence[str], family: str, seed: int
) -> Row | None:
    """Return the row of one run; None for a seed without a fair world."""
    try:
        scenario = load_scenario(family, settings_of(arguments, settings), seed)
        shortest = shortest_time(scenario, seed)
    except ScenarioError:
        return None
    row = walk(scenario, seed, fast=arguments.loop == "fast", exact=arguments.exact)
    return {"family": family, "seed": seed, "shortest": round(shortest, 2), **row}


def read(raw: Path) -> list[Row]:
    """Return all rows so far."""
    return [json.loads(line) for line in raw.read_text().splitlines()] if raw.exists() else []


if __name__ == "__main__":
    main()
