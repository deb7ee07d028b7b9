"""Tune the planners, or the constants that Yoo & Kim do not print.

    python scripts/tune.py baselines --out runs/baselines
    python scripts/tune.py paper --out runs/paper

Every arm gets the same effort: `--candidates` parameter sets, the first by hand and the others
drawn, on `--seeds` worlds; the best `--finalists` get `--more` worlds, and the best over all of
them wins. A run has the kinematic body and ends at the first collision; its score is the fraction
of its legs until then, 1 for a success. The study `baselines`, which includes the default planner,
uses the analytic camera and worlds with twice as many movers. The study `paper` uses the
omnidirectional camera and has one arm per row of weights of eq. (10), printed and exchanged. Runs
are kept in the folder, and the same command continues.

The shipped values of the baselines were found with a planar body instead, see docs/notes.md.
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation

import numpy as np
from study import STAND_INS

Ranges = Mapping[str, tuple[float, float, float]]
Values = dict[str, float]
Row = dict[str, object]

PLANNERS = "navigation.planner"
# Parameter: minimum, value by hand, maximum; drawn uniformly in the logarithm.
BASELINES: dict[str, Ranges] = {
    "univector": {
        "navigation.univector.margin": (0.02, 0.05, 0.1),
        "navigation.univector.eta_vo": (0.1, 0.5, 1.5),
        "navigation.univector.eta_imp": (0.01, 0.05, 0.2),
        "navigation.univector.d_e": (0.05, 0.2, 0.4),
        "navigation.univector.d_b": (0.1, 0.25, 0.6),
        "navigation.univector.k_r": (0.05, 0.3, 0.5),
        "navigation.safety_filter.moving_horizon": (1.5, 3.5, 6.0),
        "navigation.safety_filter.particle_weight": (0.1, 0.5, 2.0),
        "navigation.safety_filter.urgent_loss": (20.0, 70.0, 200.0),
        "navigation.safety_filter.collision_loss": (5.0, 20.0, 60.0),
        "navigation.safety_filter.change_loss": (0.1, 0.5, 2.0),
    },
    "n-posture": {
        "margin": (0.02, 0.05, 0.1), "gain": (1.0, 2.0, 8.0), "offset": (0.05, 0.25, 0.4),
        "lead": (0.2, 1.0, 3.0), "d_min": (0.01, 0.05, 0.15), "delta": (0.05, 0.15, 0.3),
    },
    "apf": {
        "margin": (0.02, 0.05, 0.1), "influence": (0.15, 0.45, 0.8), "gain": (0.005, 0.02, 0.2),
        "reaction": (0.3, 0.8, 3.0), "swirl": (0.1, 0.6, 2.0),
    },
    "orca": {
        "margin": (0.02, 0.05, 0.1), "horizon": (2.0, 5.0, 10.0),
        "static_horizon": (0.8, 2.0, 5.0),
    },
    "dwa": {
        "margin": (0.02, 0.05, 0.1), "horizon": (1.5, 3.0, 6.0),
        "heading_weight": (0.1, 0.3, 1.0), "clearance_weight": (0.1, 0.4, 2.0),
        "clearance": (0.08, 0.25, 0.4), "contact_weight": (2.0, 6.0, 20.0),
    },
    "mppi": {
        "margin": (0.02, 0.05, 0.1), "spread": (0.2, 0.5, 1.0), "persistence": (0.5, 0.8, 0.95),
        "temperature": (0.01, 0.05, 0.3), "heading_weight": (0.05, 0.2, 1.0),
        "clearance_weight": (0.1, 0.5, 2.0), "clearance": (0.08, 0.15, 0.4),
        "contact_weight": (2.0, 8.0, 20.0),
    },
}  # fmt: skip
PAPER: Ranges = {
    "navigation.univector.margin": (0.01, 0.03, 0.1),
    "navigation.univector.eta_vo": (0.1, 0.5, 1.5),
    "navigation.univector.eta_imp": (0.01, 0.05, 0.2),
    "navigation.planner.paper.d_con": (0.3, 0.8, 1.5),
    "navigation.planner.paper.d_e": (0.05, 0.15, 0.8),
    "navigation.planner.paper.d_b": (0.1, 0.3, 1.6),
    "navigation.planner.paper.k_r": (0.05, 0.3, 1.0),
    "navigation.planner.paper.omega_dist": (2.0, 12.0, 24.0),
    "navigation.planner.paper.horizon": (2.0, 6.0, 10.0),
    "navigation.planner.paper.nominal": (0.5, 0.75, 1.0),
}
PROFILE = ("navigation.profile=paper", "camera.source=omnidirectional")


@dataclass(frozen=True)
class Arm:
    """Planner or reading to tune.

    Attributes:
        name: name in the table.
        settings: settings of every run.
        prefix: common beginning of the keys of its parameters.
        ranges: minimum, value by hand and maximum of each parameter.
    """

    name: str
    settings: tuple[str, ...]
    prefix: str
    ranges: Ranges

    def sets(self, count: int) -> Iterator[Values]:
        """Yield the values by hand, then `count` - 1 sets drawn from the ranges."""
        rng = np.random.default_rng(np.random.SeedSequence([ord(letter) for letter in self.name]))
        yield {name: hand for name, (_, hand, _) in self.ranges.items()}
        for _ in range(count - 1):
            yield {
                name: float(f"{np.exp(rng.uniform(np.log(low), np.log(high))):.3g}")
                for name, (low, _, high) in self.ranges.items()
            }

    def words(self, values: Values) -> tuple[str, ...]:
        """Return all settings of a run with these values."""
        return (*self.settings, *(f"{self.prefix}{key}={v}" for key, v in values.items()))


def arms(study: str) -> list[Arm]:
    """Return the arms of a study: the planners, or both rows of weights of eq. (10)."""
    if study == "paper":
        rows = ("printed", "exchanged")
        weights = "navigation.planner.paper.weights"
        return [Arm(row, (*PROFILE, f"{weights}={row}"), "", PAPER) for row in rows]
    return [
        Arm(
            name,
            (f"navigation.planner.method={name}", "world.n_moving=8"),
            "" if name == "univector" else f"{PLANNERS}.{name.replace('-', '_')}.",
            ranges,
        )
        for name, ranges in BASELINES.items()
    ]


def walk(words: Sequence[str], seed: int) -> Row:
    """Run until the goal, the first collision or the time limit.

    Args:
        words: settings of the scenario `course`.
        seed: seed of the world and of all noise.

    Returns:
        Score [1], success, and time [s].
    """
    simulation = Simulation(load_scenario("course", [*STAND_INS, *words]), seed)
    index = 0
    with simulation:
        for tick in simulation:
            if tick.record is None:
                continue
            if tick.record.frame is not None:
                index = tick.record.frame.task.index
            if tick.record.truth.contacts:
                simulation.interrupt()
    success = simulation.exit_reason == "goal"
    score = 1.0 if success else index / len(simulation.layout.waypoints)
    return {"score": round(score, 3), "success": success, "time": round(simulation.time, 2)}


class Study:
    """Runs of a study, kept in a JSON Lines file."""

    def __init__(self, file: Path) -> None:
        self._file = file
        lines = file.read_text().splitlines() if file.exists() else []
        self._done: dict[str, Row] = {}
        for row in map(json.loads, lines):
            self._done[row.pop("key")] = row

    def rows(self, arm: Arm, values: Values, seeds: Sequence[int]) -> list[Row]:
        """Return the results of a parameter set; runs without one are made in parallel."""
        words = arm.words(values)
        keys = {seed: json.dumps([words, seed]) for seed in seeds}
        missing = [seed for seed, key in keys.items() if key not in self._done]
        with ProcessPoolExecutor() as pool, self._file.open("a") as file:
            rows = pool.map(walk, [words] * len(missing), missing)
            for seed, row in zip(missing, rows, strict=True):
                self._done[keys[seed]] = row
                print(json.dumps({"key": keys[seed], **row}), file=file, flush=True)
        return [self._done[key] for key in keys.values()]


def merit(rows: Sequence[Row]) -> tuple[float, float]:
    """Return the mean score, and the negative mean time of the successes as a tie-break [s]."""
    times = [float(str(row["time"])) for row in rows if row["success"]] or [999.0]
    return float(np.mean([float(str(row["score"])) for row in rows])), -float(np.mean(times))


def tune(study: Study, arm: Arm, options: argparse.Namespace) -> str:
    """Tune an arm; return its line of the table."""
    few, every = range(options.seeds), range(options.seeds + options.more)
    hand, *drawn = arm.sets(options.candidates)
    drawn.sort(key=lambda values: merit(study.rows(arm, values, few)), reverse=True)
    final = {json.dumps(v): study.rows(arm, v, every) for v in (hand, *drawn[: options.finalists])}
    best = max(final, key=lambda text: merit(final[text]))
    cells = [arm.name]
    for rows in (final[json.dumps(hand)], final[best]):
        successes = sum(bool(row["success"]) for row in rows)
        cells.append(f"{merit(rows)[0]:.3f}, {successes} of {len(rows)}")
    cells.append(", ".join(f"`{key}` {value:g}" for key, value in json.loads(best).items()))
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Tune all arms and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("baselines", "paper"))
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    parser.add_argument("--only", nargs="+", metavar="ARM", help="arms to tune; default: all")
    parser.add_argument("--candidates", type=int, default=16)
    parser.add_argument("--seeds", type=int, default=6, help="worlds of each set, from seed 0")
    parser.add_argument("--finalists", type=int, default=3)
    parser.add_argument("--more", type=int, default=10, help="further worlds of the finalists")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    study = Study(options.out / f"{options.study}.jsonl")
    print("| arm | score and successes by hand | tuned | values |\n|---|---|---|---|", flush=True)
    for arm in arms(options.study):
        if options.only is None or arm.name in options.only:
            print(tune(study, arm, options), flush=True)


if __name__ == "__main__":
    main()
