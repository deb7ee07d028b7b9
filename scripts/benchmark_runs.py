"""Runs of the results: the cells of `benchmarks.toml`, their sweeps, and what is missing.

A cell is one scenario of one arm, at one level if the arm has levels: one sweep of
``hsr8 sweep``, which continues a stopped one by itself.
"""

import os
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from hsr8.robots.file.description import read_description
from hsr8.robots.file.locate import find_description, installed_model
from hsr8.sweep.folder import SweepFolder
from hsr8.sweep.seeds import parse_seeds

DEFINITION = Path(__file__).with_suffix("").with_name("benchmarks.toml")
NOTHING_RAN, LOST, INTERRUPTED = 2, 3, 130  # exit codes of a sweep


@dataclass(frozen=True)
class Cell:
    """One sweep.

    Attributes:
        arm: name of the arm.
        level: label of the level; "" for an arm without levels.
        scenario: name of the scenario.
        seeds: seeds of the runs.
        settings: settings of the arm and of the level.
        workers: parallel runs; None for the number of CPUs.
        seconds: estimated processor time of a run [s].
    """

    arm: str
    level: str
    scenario: str
    seeds: tuple[int, ...]
    settings: tuple[str, ...]
    workers: int | None
    seconds: float

    def folder(self, root: Path) -> Path:
        """Return the folder of the sweep below the folder of all."""
        level = self.level.replace(" ", "-").replace("/", "-per-").replace("%", "percent")
        return root / self.arm / (f"{self.scenario}-{level}" if level else self.scenario)

    def results(self, root: Path) -> list[dict[str, Any]]:
        """Return the results of the runs that ended, by seed; none if the sweep has not begun."""
        folder = self.folder(root)
        if not folder.exists():
            return []
        results = SweepFolder.read(folder).results()
        return [dict(run) for run in results if run["seed"] in self.seeds]

    def missing(self, root: Path) -> int:
        """Return the number of runs without a result."""
        return len(self.seeds) - len(self.results(root))

    def remaining(self, root: Path) -> float:
        """Return the estimated processor time of the missing runs [s]."""
        results = self.results(root)
        measured = [run["process_s"] for run in results if run.get("process_s")]
        each = sum(measured) / len(measured) if measured else self.seconds
        return (len(self.seeds) - len(results)) * each

    def unavailable(self) -> str | None:
        """Return the robot whose model is not installed, None if the cell can run."""
        for setting in self.settings:
            key, _, robot = setting.partition("=")
            if key == "robot.model":
                file = find_description(robot)
                if installed_model(read_description(file), file.parent) is None:
                    return robot
        return None

    def command(self, root: Path) -> list[str]:
        """Return the command of the sweep."""
        words = ["sweep", self.scenario, "--seeds", ",".join(map(str, self.seeds))]
        words += ["--out", str(self.folder(root)), "--keep", "none", "--quiet"]
        words += ["--workers", str(self.workers)] if self.workers else []
        for setting in self.settings:
            words += ["--set", setting]
        return [sys.executable, "-m", "hsr8", *words]

    def run(self, root: Path) -> None:
        """Make the missing runs.

        Raises:
            SystemExit: no run of the sweep was possible, or it was interrupted.
        """
        code = subprocess.run(self.command(root), check=False).returncode
        if code in (NOTHING_RAN, INTERRUPTED) or code > INTERRUPTED or code < 0:
            sys.exit(f"{self.folder(root)}: sweep ended with exit code {code}")


class Definition:
    """Definition of the results.

    Args:
        file: TOML file.
        runs: maximum number of runs per cell; None for all.

    Attributes:
        pages: tables of the pages by name.
        headline: rows of the table in the README: label, text, page.
        index: texts of the index.
    """

    def __init__(self, file: Path = DEFINITION, runs: int | None = None) -> None:
        content = tomllib.loads(file.read_text(encoding="utf-8"))
        self._arms = content["arms"]
        self._runs = runs
        self.pages: dict[str, dict[str, Any]] = content["pages"]
        self.headline: list[list[str]] = content["headline"]["rows"]
        self.index: dict[str, str] = content["index"]

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """All cells, in the order of the pages."""
        names = dict.fromkeys(arm for page in self.pages.values() for arm in page["arms"])
        return tuple(cell for name in names for cell in self.cells_of(name))

    def cells_of(self, arm: str) -> tuple[Cell, ...]:
        """Return the cells of an arm."""
        table = self._resolved(arm)
        levels = self._arms[arm].get("levels", {"": None})
        return tuple(
            Cell(
                arm,
                level,
                scenario,
                parse_seeds(table["seeds"])[: self._runs],
                (*table["settings"], *([more] if more else [])),
                table.get("workers"),
                table["seconds"],
            )
            for level, more in levels.items()
            for scenario in table["scenarios"]
        )

    def page_cells(self, pages: Sequence[str]) -> tuple[Cell, ...]:
        """Return the cells that pages show, in order."""
        arms = dict.fromkeys(arm for page in pages for arm in self.pages[page]["arms"])
        return tuple(cell for arm in arms for cell in self.cells_of(arm))

    def _resolved(self, arm: str) -> dict[str, Any]:
        """Return the table of an arm, completed by the arm that it is like."""
        own = self._arms[arm]
        base = self._resolved(own["like"]) if "like" in own else {"settings": []}
        return {**base, **own, "settings": [*base["settings"], *own.get("settings", [])]}


def workers() -> int:
    """Return the number of CPUs of this process."""
    return len(os.sched_getaffinity(0))
