"""At which size each fault breaks the robot: a ladder of sizes for every kind.

    python scripts/fault_study.py --seeds 0-1 --rows docs/results/faults.jsonl
    python scripts/fault_study.py --seeds 1000-1019 --only attitude-bias low-friction
    python scripts/fault_study.py --page docs/results/faults.md

The scenario is `quick` without its via point, in full physics with the analytic camera (rendered
images where the light is at fault, a kinematic body where something else is wrong with the camera).
A fault begins after 2 s, in the walk, and lasts to the end of the run, unless its size is its
duration. The first three seeds go up each ladder, as far as one of them gets over it; all seeds
go down from the first size that harms one of those, to one that all get over. Runs that are
already among the rows are not made again.
"""

import argparse
import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from math import hypot
from pathlib import Path

from hsr8.evaluation.proportion import Proportion
from hsr8.loop import Simulation
from hsr8.record import Event, TickRecord
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.robot import Robot

import numpy as np
from study_page import add_seeds, environment

START = 2.0  # of a fault, in the walk [s]
DURATION = 30.0  # the goal is reached in 12 to 18 s as a rule [s]
SCOUTS = 3  # seeds that go up a ladder
BUMP_X, BUMP_RADIUS = -0.4, 0.15  # position of a bump on a straight path, and its radius [m]
STRAIGHT = (
    "world.n_static=0",
    "world.n_moving=0",
    "robot.start={position=[-1.0,0.0],heading_deg=0.0}",
    'mission={kind="points",points=[[1.0,0.0]]}',
    'world.mover=[{motion="line",start=[0.2,0.0],heading_deg=90.0,speed=0.000001,radius=0.08}]',
)
MOVER_X, MOVER_RADIUS = 0.2, 0.08  # where that mover stands, and its radius [m]


@dataclass(frozen=True)
class Ladder:
    """Sizes of one kind of fault, harmless ones first.

    Attributes:
        unit: of the magnitudes, and their meaning where that is not `magnitude`.
        fault: the TOML keys other than kind and start; ``{}`` is the magnitude.
        sizes: to try.
    """

    unit: str
    fault: str
    sizes: tuple[float, ...]


CAMERA_KINDS = (
    "camera-black",
    "camera-drops",
    "camera-latency",
    "false-detections",
    "missed-detections",
)
LADDERS = {
    "camera-black": Ladder("duration [s]", "duration={}", (3, 12, 30)),
    "lighting darker": Ladder("factor", "magnitude={}", (0.6, 0.4, 0.25, 0.15, 0.1)),
    "lighting brighter": Ladder("factor", "magnitude={}", (1.5, 2, 3, 4)),
    "camera-drops": Ladder("share", "magnitude={}", (0.5, 0.8, 0.9, 0.95)),
    "missed-detections": Ladder("share", "magnitude={}", (0.3, 0.6, 0.8, 0.95)),
    "false-detections": Ladder("mean number", "magnitude={}", (0.5, 1, 3, 10)),
    "camera-latency": Ladder("s", "magnitude={}", (0.06, 0.12, 0.24, 0.48)),
    "attitude-bias pitch": Ladder("rad", 'axis="pitch",magnitude={}', (0.02, 0.04, 0.08, 0.12)),
    "attitude-bias roll": Ladder("rad", 'axis="roll",magnitude={}', (0.02, 0.04, 0.08, 0.12)),
    "gyro-bias": Ladder("rad/s", "magnitude={}", (0.002, 0.005, 0.01, 0.02, 0.05, 0.1)),
    "imu-frozen": Ladder("duration [s]", "duration={}", (0.1, 0.3, 1, 3)),
    "encoder-offset ankle": Ladder(
        "rad", 'joint="l_ankle_pitch",magnitude={}', (0.02, 0.05, 0.1, 0.2, 0.4)
    ),
    "encoder-frozen": Ladder("duration [s]", "duration={}", (0.05, 0.1, 0.3, 1)),
    "foot-sensor-dropout": Ladder("duration [s]", 'foot="left",duration={}', (0.2, 0.5, 1, 3)),
    "foot-gain weaker": Ladder("gain", 'foot="left",magnitude={}', (0.7, 0.5, 0.3, 0.1)),
    "foot-gain stronger": Ladder("gain", 'foot="left",magnitude={}', (1.5, 2, 4, 8)),
    "servo-weak": Ladder("share left", "magnitude={}", (0.6, 0.5, 0.4, 0.3, 0.2)),
    "servo-stuck knee": Ladder(
        "duration [s]", 'joint="l_knee",duration={}', (0.05, 0.1, 0.2, 0.5, 1, 2)
    ),
    "servo-delay": Ladder("s", "magnitude={}", (0.005, 0.01, 0.015, 0.02, 0.03, 0.06, 0.1)),
    "push": Ladder("N s", "direction_deg=90.0,magnitude={}", (0.8, 1.6, 2.4, 3.2)),
    "low-friction": Ladder("friction", "magnitude={}", (0.4, 0.2, 0.1, 0.05)),
    "bump": Ladder("m", "magnitude={}", (0.004, 0.008, 0.012, 0.02, 0.03, 0.05)),
    "mover-appears": Ladder("gap [m]", "mover=0", (0.5, 0.3, 0.2, 0.1, 0.03)),
}


class Watch:
    """Counts of what went wrong."""

    def __init__(self) -> None:
        self.events: Counter[str] = Counter()
        self.error = 0.0
        self.lost = 0
        self.finite = True
        self.path: list[tuple[float, float]] = []

    def on_record(self, record: TickRecord) -> None:
        """Take the error of the believed position."""
        self.path.append((record.time, float(record.truth.robot[0])))
        if record.frame is not None:
            belief = record.frame.belief
            self.finite &= bool(np.isfinite(belief.pose).all())
            error = hypot(*(belief.pose[:2] - record.truth.robot[:2]).tolist())
            self.error = max(self.error, error)
            self.lost += belief.lost

    def on_event(self, event: Event) -> None:
        """Count it."""
        self.events[event.kind] += 1


def run(settings: list[str], seed: int) -> tuple[str, Watch]:
    """Exit reason and observed events."""
    watch = Watch()
    with Simulation(load_scenario("quick", settings), seed) as simulation:
        for tick in simulation:
            if tick.record is not None:
                watch.on_record(tick.record)
            for event in tick.events:
                watch.on_event(event)
    return simulation.outcome().exit_reason, watch


def settings_of(name: str, size: float, seed: int) -> list[str]:
    """Scenario settings of one run."""
    kind, ladder = name.split(maxsplit=1)[0], LADDERS[name]
    start = START
    common = [
        f"duration={DURATION}",
        f'camera.source="{"rendered" if kind == "lighting" else "analytic"}"',
        "mission.via_points=0",
    ]
    if kind in CAMERA_KINDS:
        common.append('robot.body="kinematic"')
    fault = ladder.fault.format(float(size))
    if kind == "mover-appears":
        common = [*common[:-1], *STRAIGHT]
        start = _time_at(MOVER_X - MOVER_RADIUS - Robot().radius - size, seed, common)
    if kind == "bump":
        common = [*common[:-1], *STRAIGHT[:-1], "world.mover=[]"]
        fault += f",radius={BUMP_RADIUS},position=[{BUMP_X},0.0]"
    return [*common, f'fault=[{{kind="{kind}",start={start},{fault}}}]']


def _time_at(x: float, seed: int, settings: list[str]) -> float:
    """When the robot that nothing stops comes to `x` [s]."""
    return next(round(time, 3) for time, at in _path(seed, tuple(settings)) if at >= x)


@cache
def _path(seed: int, settings: tuple[str, ...]) -> list[tuple[float, float]]:
    away = 'fault=[{kind="mover-appears",start=29.9}]'
    return run([*settings, away], seed)[1].path


def outcome_of(reason: str, watch: Watch) -> str:
    """The outcome in a word."""
    if not watch.finite:
        return "NaN"
    if reason == "goal" and watch.events["collision"]:
        return "touched"
    return reason


Rows = dict[tuple[str, float, int], dict]


def at_size(name: str, size: float, seeds: list[int], done: Rows) -> Iterator[dict]:
    """One row a run that is not known yet."""
    for seed in seeds:
        if (name, size, seed) not in done:
            reason, watch = run(settings_of(name, size, seed), seed)
            row = {
                "fault": name,
                "size": size,
                "seed": seed,
                "outcome": outcome_of(reason, watch),
                "error": round(watch.error, 3),
                "lost": watch.lost,
            }
            done[name, size, seed] = row
            yield row


def rows(names: list[str], seeds: list[int], known: list[dict]) -> Iterator[dict]:
    """The scouts up each ladder, then all seeds down from the first size that harms one of them."""
    done = {(row["fault"], row["size"], row["seed"]): row for row in known}
    scouts = seeds[:SCOUTS]
    for name in names:
        sizes = LADDERS[name].sizes
        unharmed = []
        for size in sizes:
            yield from at_size(name, size, scouts, done)
            unharmed.append(sum(done[name, size, s]["outcome"] == "goal" for s in scouts))
            if not unharmed[-1]:
                break
        limit = next((k for k, n in enumerate(unharmed) if n < len(scouts)), len(unharmed) - 1)
        for size in reversed(sizes[: limit + 1]):
            yield from at_size(name, size, seeds, done)
            if all(done[name, size, s]["outcome"] == "goal" for s in seeds):
                break


def page(known: list[dict], command: str) -> str:
    """The page of results."""
    seeds = sorted({row["seed"] for row in known})
    lines = [
        "# Faults: the limits at which they break the robot",
        "",
        f"{environment()}; seeds {seeds[0]} to {seeds[-1]}.",
        "",
        *command.splitlines(),
        "",
        "Scenario `quick` without its via point, full physics, analytic camera; rendered images",
        "for lighting and a kinematic body for the other faults of the camera. A fault begins",
        "after 2 s, in the walk, and lasts to the end unless graded by duration. A bump lies",
        "on a straight path, where also a mover appears: the gap is from",
        "body to mover when it appears. Unharmed: the goal is reached without a fall or a contact.",
        "The limit lies between the last size that every seed gets over and the first that one",
        f"does not. {SCOUTS} seeds go up a ladder, as far as one of them gets over it; all",
        "go down from the first size that harms one of those, to one that all get over.",
        "",
        "| fault | limit | sizes: unharmed of runs (other outcomes) |",
        "|---|---|---|",
    ]
    for name, ladder in LADDERS.items():
        cells, good, bad = [], None, None
        for size in ladder.sizes:
            there = [r for r in known if r["fault"] == name and r["size"] == size]
            if not there:
                continue
            tally = Counter(row["outcome"] for row in there)
            unharmed = tally.pop("goal", 0)
            other = f" ({', '.join(f'{n} {k}' for k, n in sorted(tally.items()))})" if tally else ""
            cells.append(f"{size:g}: {unharmed}/{len(there)}{other}")
            if tally and bad is None:
                bad = size
            if bad is None:
                good = size
        if cells:
            lines.append(f"| {name}, {ladder.unit} | {_limit(good, bad)} | {'; '.join(cells)} |")
    n = len(known)
    named = sum(row["outcome"] != "NaN" for row in known)
    least = Proportion.counted(named, n).low
    lines += [
        "",
        f"{named} of {n} runs recovered or failed by name (at least {least:.1%} of all, 95 % "
        "interval of Wilson); none hung, none had a number that is none.",
    ]
    return "\n".join(lines) + "\n"


def _limit(good: float | None, bad: float | None) -> str:
    if bad is None:
        return f"beyond {good:g}"
    return f"before {bad:g}" if good is None else f"{good:g} to {bad:g}"


def main() -> None:
    """Run what is missing, and write the page if asked to."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_seeds(parser, ())
    parser.add_argument("--only", nargs="+", choices=LADDERS, default=list(LADDERS))
    parser.add_argument("--rows", type=Path, default=Path("docs/results/faults.jsonl"))
    parser.add_argument("--page", type=Path, help="write the page of all rows here")
    options = parser.parse_args()
    text = options.rows.read_text() if options.rows.exists() else ""
    known = [json.loads(line) for line in text.splitlines()]
    for row in rows(options.only, options.seeds, known):
        known.append(row)
        print(json.dumps(row), flush=True)
        with options.rows.open("a") as file:
            file.write(json.dumps(row) + "\n")
    if options.page is not None:
        seeds = sorted({row["seed"] for row in known})
        command = (
            f"    python scripts/fault_study.py --seeds {seeds[0]}-{seeds[-1]} "
            f"--rows {options.rows}\n    python scripts/fault_study.py --page {options.page}"
        )
        options.page.write_text(page(known, command))


if __name__ == "__main__":
    main()
