"""Determinism: equal hashes each second in repeated runs, and replays from the records.

    python scripts/determinism_study.py --light 1000:1004 --full 1000:1001 \
        --out docs/results/determinism.md

Every seed runs under four conditions, in separate processes; the hashes of world and belief of
every simulated second must be those of the first. Then physics, estimator and decisions of every
run are computed again from its records.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hsr8.evaluation.replay import replay
from hsr8.evaluation.sweep.definition import Definition
from hsr8.recorder.run.run import Run
from hsr8.recorder.run.run_reader import open_run
from hsr8.scenario.loader import dump, load_scenario
from walking.parameters import CONTROL_PERIOD

from study_page import command_line, seeds_of

STAND_INS = ("--body", "kinematic", "--camera", "analytic")


@dataclass(frozen=True)
class Case:
    """Conditions of a run.

    Attributes:
        name: label.
        seed: of the run.
        words: command line without the seed.
        duration: simulated time [s].
    """

    name: str
    seed: int
    words: tuple[str, ...]
    duration: str

    def run(self, out: Path, *more: str) -> Run:
        """Run in a separate process."""
        words = ["run", "course", "--seed", str(self.seed), "--quiet", *self.words]
        words += ["--duration", self.duration, *more, "--out", str(out)]
        command("-m", "hsr8", *words)
        return open_run(out)


def command(*words: str, codes: tuple[int, ...] = (0, 1)) -> None:
    """Run Python with `words`; exit code 1 means that a criterion is not met."""
    done = subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False)
    if done.returncode not in codes:
        raise SystemExit(f"{words}: exit code {done.returncode}\n{done.stderr}")


def swept(case: Case, out: Path, workers: int) -> Run:
    """Run the case as one of two runs of a sweep."""
    words = ["sweep", "course", "--seeds", f"{case.seed},{case.seed + 1}", *case.words]
    words += ["--duration", case.duration, "--workers", str(workers), "--quiet", "--out", str(out)]
    command("-m", "hsr8", *words)
    (folder,) = (out / "runs").glob(f"*/{case.seed}-*")
    return open_run(folder)


CONDITIONS: dict[str, Callable[[Case, Path], Run]] = {
    "no log": lambda case, out: case.run(out),
    "log": lambda case, out: case.run(out, "--log"),
    "sweep, 1 worker": lambda case, out: swept(case, out, 1),
    "sweep, 2 workers": lambda case, out: swept(case, out, 2),
}


def hashes(run: Run) -> list[tuple[int, str, str]]:
    seconds = run.seconds
    rows = zip(seconds["tick"], seconds["world"], seconds["robot"], strict=True)
    return [(int(tick), world.hex(), robot.hex()) for tick, world, robot in rows]


class Replays:
    """Counts results that are bit-exact when computed again."""

    def __init__(self) -> None:
        self.runs = 0
        self.counts: dict[tuple[str, str], list[int]] = {}

    def add(self, run: Run) -> None:
        """Compute a run again."""
        self.runs += 1
        for stage in replay(run):
            equal, different = self.counts.setdefault((stage.stage, stage.unit), [0, 0])
            self.counts[stage.stage, stage.unit] = [
                equal + stage.count * stage.equal,
                different + (not stage.equal),
            ]

    def table(self) -> list[str]:
        """Return the numbers of equal ticks and frames."""
        lines = ["| stage | equal | runs that differ |", "|---|---|---|"]
        for (stage, unit), (equal, different) in self.counts.items():
            lines.append(f"| {stage} | {equal} {unit} | {different} of {self.runs} |")
        return lines


def compare(cases: list[Case], folder: Path, replays: Replays) -> tuple[list[str], int, int]:
    """Return the table, the number of runs and the number of runs with equal hashes."""
    lines = ["| run | seconds | last hash | " + " | ".join(CONDITIONS) + " |"]
    lines.append("|---" * (len(CONDITIONS) + 3) + "|")
    runs = equal = 0
    for case in cases:
        first: list[tuple[int, str, str]] = []
        cells = []
        for number, condition in enumerate(CONDITIONS.values()):
            run = condition(case, folder / f"{case.name}-{case.seed}-{number}")
            values = hashes(run)
            first = first or values
            same = values == first
            cells.append(f"{len(values)} equal" if same else "DIFFERENT")
            runs, equal = runs + 1, equal + same
            replays.add(run)
        last, end = first[-1], first[-1][0] * CONTROL_PERIOD
        begin = f"| {case.name}, seed {case.seed} | {end:.0f} | `{last[2][:12]}`"
        lines.append(" | ".join([begin, *cells]) + " |")
        print(lines[-1], flush=True)
    return lines, runs, equal


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--light", type=seeds_of, default="1000:1004", help="seeds with stand-ins")
    parser.add_argument("--full", type=seeds_of, default="1000", help="with physics and camera")
    parser.add_argument("--duration", default="20", help="of the light runs [s]")
    parser.add_argument("--full-duration", default="20", help="of the full ones [s]")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    arguments = parser.parse_args()
    light = [Case("light", s, STAND_INS, arguments.duration) for s in arguments.light]
    full = [Case("full", s, (), arguments.full_duration) for s in arguments.full]
    replays = Replays()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        table, runs, equal = compare([*light, *full], folder, replays)
    made_with = Definition.now("course", (), dump(load_scenario("course"))).made_with()
    lines = [
        "# Same seed, same run",
        "",
        f"    {command_line()}",
        "",
        f"{made_with}.",
        "",
        f"`course`: *light* with kinematic body and analytic camera, {arguments.duration} s; "
        f"*full* with full physics and rendered camera, {arguments.full_duration} s. Every cell is "
        "a separate run: number of hashes of world and belief (each second and at the end) that "
        "equal those of the first condition.",
        "",
        f"**{equal} of {runs} runs have the hashes of the first condition of their seed.**",
        "",
        *table,
        "",
        "## Computed again from the records",
        "",
        "Physics from the setpoints of each tick, the estimator from the recorded measurements, "
        "the decisions from the recorded beliefs: `hsr8 verify`.",
        "",
        *replays.table(),
    ]
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
