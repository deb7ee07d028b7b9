"""Belief study in full physics: what the robot believes against what is true.

Runs a scenario with its body and camera as they are, keeps what reached the belief together
with the truth at each capture, feeds it to the estimator again and scores every belief.

    python scripts/belief_study.py course --seeds 1000-1019 --write docs/results/belief.md
    python scripts/belief_study.py course --seeds 0-19 --keep KEPT
    python scripts/belief_study.py course --seeds 0-19 --kept KEPT    # seconds
"""

import pickle
import sys
from dataclasses import dataclass, field
from pathlib import Path
from time import process_time
from typing import Annotated

from hsr8.loop import Simulation
from hsr8.record import TickRecord
from hsr8.robot_builder import build_estimator
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.seeds import named_rng
from hsr8.world.field.generator import draw_layout

import numpy as np
import tyro
from belief_score import Moment, Score, Thing
from study_page import seeds_of
from tyro.conf import Positional, UseAppendAction


@dataclass
class Watcher:
    """Keeps what reached the belief, with the truth at each capture."""

    moments: list[Moment] = field(default_factory=list)
    _truth: dict[int, tuple[np.ndarray, np.ndarray, np.ndarray]] = field(default_factory=dict)

    def on_record(self, record: TickRecord) -> None:
        """Remember the truth; keep a frame that arrived."""
        truth = record.truth
        self._truth[round(1e3 * record.time)] = (
            truth.robot.copy(),
            truth.obstacle_positions.copy(),
            truth.obstacle_velocities.copy(),
        )
        if record.frame is not None:
            frame = record.frame.measured
            self.moments.append(Moment(frame, *self._truth[round(1e3 * frame.time)]))


def watch(scenario: Scenario, seed: int) -> list[Moment]:
    """Run a scenario; return its frames with the truth."""
    watcher = Watcher()
    with Simulation(scenario, seed) as simulation:
        for tick in simulation:
            if tick.record is not None:
                watcher.on_record(tick.record)
    return watcher.moments


def score_run(score: Score, scenario: Scenario, seed: int, moments: list[Moment]) -> None:
    """Feed one run to the estimator and add it to the score."""
    layout = draw_layout(scenario, seed)
    objects = [Thing(o.color, o.radius, o.motion is not None) for o in layout.obstacles]
    estimator = build_estimator(scenario, layout, named_rng(seed, "belief"))
    began = process_time()
    beliefs = [estimator.update(m.frame) for m in moments]
    milliseconds = 1e3 * (process_time() - began) / len(moments)
    score.add_run(objects, zip(moments, beliefs, strict=True), milliseconds)


def write_column(path: Path, seeds: str, rows: list[tuple[str, str]]) -> None:
    """Put results into the first table of a page: held-out seeds left, tuning seeds right."""
    held_out = min(seeds_of(seeds)) >= 1000
    column = 2 if held_out else 3
    wanted = [("what", f"seeds {seeds}" + " (held out)" * held_out), *rows]
    lines = path.read_text().split("\n")
    for i, line in enumerate(lines):
        if wanted and line.startswith(f"| {wanted[0][0].strip()} |"):
            cells = [c.strip() for c in line.split("|")]
            cells[column] = wanted.pop(0)[1]
            lines[i] = " | ".join(cells).strip()
    if wanted:
        raise SystemExit(f"{path}: no row {wanted[0][0].strip()!r} in its first table")
    path.write_text("\n".join(lines))


def main(
    scenario: Positional[str],
    *,
    seeds: str = "0-9",
    duration: float = 60.0,
    set: UseAppendAction[Annotated[tuple[str, ...], tyro.conf.arg(metavar="KEY=VALUE")]] = (),
    keep: Path | None = None,
    kept: Path | None = None,
    write: Path | None = None,
) -> None:
    """Run the study and print its table.

    Args:
        scenario: name or TOML file.
        seeds: as everywhere, 1000-1019 or 1,5,9; 0-99 are for tuning, 1000 and above for reports.
        duration: simulated time of each run [s].
        set: settings of the scenario.
        keep: folder in which the frames are kept.
        kept: folder of frames kept before; nothing is run then.
        write: page whose first table takes the results up.
    """
    score = Score()
    for seed in seeds_of(seeds):
        settings = load_scenario(scenario, [f"duration={duration}", *set], seed)
        if kept is not None:
            moments = pickle.loads((kept / f"{seed}.pkl").read_bytes())
        else:
            moments = watch(settings, seed)
        if keep is not None:
            keep.mkdir(parents=True, exist_ok=True)
            (keep / f"{seed}.pkl").write_bytes(pickle.dumps(moments))
        score_run(score, settings, seed, moments)
        print(f"seed {seed}: {len(moments)} frames", file=sys.stderr, flush=True)
    print(f"| {scenario}, seeds {seeds}, {duration:g} s each | |\n|---|---|")
    for name, value in score.rows():
        print(f"| {name.strip()} | {value} |")
    if write is not None:
        write_column(write, seeds, score.rows())


if __name__ == "__main__":
    tyro.cli(main)
