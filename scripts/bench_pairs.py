"""Two checkouts timed on one machine in turn, stage by stage."""

import re
import subprocess
from pathlib import Path
from statistics import median

ROW = re.compile(r"^\| ([^|]+) \|.*\| ([\d.]+) \| ([\d.]+) \|$", re.MULTILINE)
FLOOR = "floor: physics"

Turn = dict[str, tuple[float, float]]


def turn_of(text: str) -> Turn:
    """Return time per simulated second [ms] and floors [1] of each stage in a printed table."""
    return {stage: (float(second), float(floors)) for stage, second, floors in ROW.findall(text)}


def timed(checkout: Path, words: list[str]) -> Turn:
    """Time one run in a checkout with its own code and environment.

    Args:
        checkout: folder of the checkout, with its `.venv`.
        words: options of its `scripts/bench.py`.
    """
    command = [str(checkout / ".venv/bin/python"), "scripts/bench.py", *words]
    done = subprocess.run(command, cwd=checkout, stdout=subprocess.PIPE, text=True, check=True)
    return turn_of(done.stdout)


def pairs(here: Path, there: Path, words: list[str], turns: int) -> list[tuple[Turn, Turn]]:
    """Time two checkouts in turn.

    Args:
        here: checkout with the new code.
        there: checkout to compare with.
        words: options of `scripts/bench.py` that both know.
        turns: number of pairs.
    """
    return [(timed(here, [*words, "--turns", "1"]), timed(there, words)) for _ in range(turns)]


def comparison(turns: list[tuple[Turn, Turn]]) -> list[str]:
    """Return a table of the medians of all stages and their ratios.

    A stage that only one checkout lists, such as garbage collections, has an empty cell.
    """
    lines = ["| stage | here [floors] | there [floors] | ratio |", "|---|---|---|---|"]
    for stage in turns[0][0]:
        here = median(here[stage][1] for here, _ in turns)
        others = [there[stage][1] for _, there in turns if stage in there]
        there = median(others) if others else 0.0
        cells = f"{there:.3f} | {here / there:.2f}" if there else "|"
        lines.append(f"| {stage} | {here:.3f} | {cells} |")
    first, other = (median(turn[k][FLOOR][0] for turn in turns) for k in (0, 1))
    speeds = f"a second of physics alone took {first:.0f} and {other:.0f} ms"
    return [*lines, "", f"Medians of {len(turns)} turns; {speeds}."]
