"""Where the time of the closed loop goes, and how far it is from the floor under it.

    python scripts/bench.py                       # `course`, 40 s
    python scripts/bench.py --check               # against the kept ratios

The floor is MuJoCo stepping the same model with constant controls and rendering as many
images. It runs in turn with the loop, second by second, so that the ratio of the two holds
on any machine and while other work comes and goes. Times are processor time; the time of
the threads that draw and write in parallel is listed separately and included in the total, as are
garbage collections, which are as rare as in the command line. The first call of each stage is left
out: it loads compiled code. Of several runs, the one with the median total is shown.
"""

import argparse
import gc
import json
from importlib.metadata import version
from pathlib import Path
from statistics import median

from hsr8.cli.main import COLLECT_AFTER
from hsr8.files import atomic
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation

from loop_bench import Bench

BASELINE = Path(__file__).with_name("loop-ratios.json")
PACKAGES = ("hsr8", "mujoco", "numba", "numpy", "rerun-sdk")
CHECKED = ("course", 5, "duration=8")  # scenario, seed and length that the check runs
SLOWER = 1.2  # ratio to the baseline from which a stage is reported [1]
SMALL = 0.04  # stages of less than this are not looked at: chance moves them as far [floors]


def warm(scenario: str, seed: int) -> None:
    """Kernels are compiled, or read from where they are kept, before anything is timed."""
    Simulation(load_scenario(scenario, ["duration=3"], seed), seed).run()


def ratios() -> dict[str, float]:
    """Ratio of every stage to the floor in the run that is checked."""
    name, seed, length = CHECKED
    return Bench(load_scenario(name, [length], seed), seed).ratios()


def medians(runs: list[dict[str, float]]) -> dict[str, float]:
    """Median of every stage in several runs."""
    return {stage: median(run[stage] for run in runs) for stage in runs[0]}


def slower(measured: dict[str, float], kept: dict[str, float]) -> list[str]:
    """A line for every stage that is much slower than it was."""
    return [
        f"{stage}: {ratio:.2f} floors, {ratio / kept[stage] - 1.0:.0%} above {kept[stage]:.2f}"
        for stage, ratio in measured.items()
        if stage in kept and ratio > SLOWER * kept[stage] and ratio > SMALL
    ]


def check() -> None:
    """Warn of every stage that has become slower; it never fails."""
    warm(*CHECKED[:2])
    kept = json.loads(BASELINE.read_text())["ratios"]
    measured = ratios()
    if slower(measured, kept):
        measured = medians([measured, ratios(), ratios()])
    for line in slower(measured, kept):
        print(f"warning: {line}")
    print(f"the loop takes {measured['whole loop']:.2f} floors; {kept['whole loop']:.2f} are kept")


def total(bench: Bench) -> float:
    """Return the ratio of loop and floor."""
    return bench.ratio


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="course")
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--duration", type=float, default=40.0, help="simulated [s]")
    parser.add_argument("--turns", type=int, default=3, help="runs, of which the median is shown")
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE of the scenario")
    parser.add_argument("--check", action="store_true", help=f"compare with {BASELINE.name}")
    parser.add_argument("--keep", action="store_true", help=f"write {BASELINE.name}")
    options = parser.parse_args()
    gc.set_threshold(COLLECT_AFTER)
    if options.check:
        check()
        return
    warm(options.scenario, options.seed)
    if options.keep:
        runs = [ratios() for _ in range(options.turns)]
        measured = {stage: round(ratio, 3) for stage, ratio in medians(runs).items()}
        versions = {name: version(name) for name in PACKAGES}
        atomic.write_json(BASELINE, {"run": CHECKED, "of": versions, "ratios": measured})
        return
    settings = [f"duration={options.duration:g}", *options.set]
    scenario = load_scenario(options.scenario, settings, options.seed)
    runs = sorted((Bench(scenario, options.seed) for _ in range(options.turns)), key=total)
    bench = runs[len(runs) // 2]
    print(
        f"`{options.scenario}`, seed {options.seed}, {bench.simulated:g} s: "
        f"{bench.simulated / bench.loop:.2f} times real time, the floor "
        f"{bench.simulated / bench.floor:.1f}; the loop takes {bench.ratio:.2f} floors.\n"
    )
    print("\n".join(bench.table()))


if __name__ == "__main__":
    main()
