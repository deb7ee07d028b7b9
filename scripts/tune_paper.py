"""Tune the constants that Yoo & Kim do not print, for both readings of eq. (10).

    python scripts/tune_paper.py --out paper.md

Conditions are those of the paper: a planar body and perfect sensing (`fast_loop.py`). Each reading
gets `--candidates` sets of constants, the first by hand and the others drawn, on `--seeds`
worlds; the best `--finalists` get `--more` worlds, and the best over all of them wins. The score
of a run is the fraction of its legs without a contact. Runs are kept next to the page, and a
study that is started again continues.
"""

import argparse
import json
from pathlib import Path

from hsr8.scenario.loader import load_scenario

import numpy as np
from fast_loop import FastRun
from gaze_arms import PAPERS
from tune_baselines import Settings, drawn

READINGS = ("printed", "exchanged")
# Key: smallest value, value by hand, largest; drawn uniformly in the logarithm.
RANGES = {
    "navigation.univector.margin": (0.01, 0.03, 0.1),
    "navigation.univector.eta_vo": (0.1, 0.5, 1.5),
    "navigation.univector.eta_imp": (0.01, 0.05, 0.2),
    "navigation.univector.d_con": (0.3, 0.8, 1.5),
    "navigation.univector.d_e": (0.1, 0.4, 0.8),
    "navigation.univector.d_b": (0.1, 0.8, 1.6),
    "navigation.univector.k_r": (0.05, 0.3, 1.0),
    "navigation.moving_obstacles.margin": (0.02, 0.05, 0.1),
    "navigation.moving_obstacles.horizon": (2.0, 6.0, 10.0),
    "constants.navigation.moving_obstacles.omega_dist": (2.0, 12.0, 24.0),
}
Row = dict[str, object]


class Study:
    """Runs of both readings, kept in a JSON Lines file."""

    def __init__(self, file: Path) -> None:
        self._file = file
        lines = file.read_text().splitlines() if file.exists() else []
        self._done = {self._key(**json.loads(line)): json.loads(line) for line in lines}

    @staticmethod
    def _key(reading: str, values: Settings, seed: int, **_: object) -> tuple[str, str, int]:
        return reading, json.dumps(values), seed

    def score(self, reading: str, values: Settings, seeds: range) -> float:
        """Return the mean score of a set of constants."""
        return float(np.mean([self._run(reading, values, seed)["legs"] for seed in seeds]))

    def successes(self, reading: str, values: Settings, seeds: range) -> int:
        """Return the number of successes of a set of constants."""
        return sum(bool(self._run(reading, values, seed)["success"]) for seed in seeds)

    def _run(self, reading: str, values: Settings, seed: int) -> Row:
        key = self._key(reading, values, seed)
        if key not in self._done:
            settings = [*PAPERS[reading].split(), *(f"{k}={v}" for k, v in values.items())]
            outcome = FastRun(load_scenario("course", settings, seed), seed, exact=True).run()
            row = {"reading": reading, "values": values, "seed": seed}
            self._done[key] = row | {"success": outcome.success, "legs": outcome.legs}
            with self._file.open("a") as file:
                file.write(json.dumps(self._done[key]) + "\n")
        return self._done[key]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--reading", nargs="*", choices=READINGS, default=READINGS)
    parser.add_argument("--candidates", type=int, default=32)
    parser.add_argument("--seeds", type=int, default=8, help="worlds of each set, from seed 0")
    parser.add_argument("--finalists", type=int, default=4)
    parser.add_argument("--more", type=int, default=16, help="further worlds of the finalists")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    options = parser.parse_args()
    study = Study(options.out.with_suffix(".jsonl"))
    few, all_seeds = range(options.seeds), range(options.seeds + options.more)
    lines = [
        "| reading | score by hand | tuned | successes by hand | tuned | values |",
        "|---" * 6 + "|",
    ]
    for reading in options.reading:
        first, *others = drawn(RANGES, options.candidates, np.random.default_rng(10))
        ranked = sorted(others, key=lambda v: study.score(reading, v, few), reverse=True)
        final = [first, *ranked[: options.finalists]]
        best = max(final, key=lambda v: study.score(reading, v, all_seeds))
        scores = [f"{study.score(reading, v, all_seeds):.2f}" for v in (first, best)]
        good = [
            f"{study.successes(reading, v, all_seeds)} of {len(all_seeds)}" for v in (first, best)
        ]
        chosen = " ".join(f"{key}={value:g}" for key, value in best.items())
        lines.append(f"| {' | '.join([reading, *scores, *good, chosen])} |")
        options.out.write_text("\n".join([*lines, ""]))


if __name__ == "__main__":
    main()
