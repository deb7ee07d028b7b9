"""Runs: tables, scenario and results, in memory or in a folder."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from hsr8.errors import UsageError
from hsr8.files.writing import FAILED
from hsr8.recorder.rows import TABLES
from hsr8.recorder.run.manifest import RUNNING
from hsr8.recorder.table import Table
from hsr8.scenario.schema import Scenario
from hsr8.suggestion import suggestion

INCOMPLETE = (RUNNING, FAILED, "interrupted", "error")  # exit reasons of runs without all records


@dataclass(frozen=True)
class Run(ABC):
    """A run.

        run = open_run("runs/course")
        run.records["zmp"]  # planned ZMP (n, 2)
        run.unit("records.zmp")  # "m"

    Attributes:
        path: folder of the run; None in memory.
        manifest: versions, seed, exit reason.
    """

    path: Path | None
    manifest: dict[str, Any]

    @property
    def seed(self) -> int:
        """Seed of the run."""
        return int(self.manifest["seed"])

    @property
    def ended(self) -> bool:
        """Whether the run ended by itself, so that its records are complete."""
        return self.manifest.get("exit_reason") not in INCOMPLETE

    @property
    def running(self) -> bool:
        """Whether the run had not ended, or was killed, when its manifest was read."""
        return bool(self.manifest.get("exit_reason") == RUNNING)

    @abstractmethod
    def scenario(self) -> Scenario:
        """Return the scenario with the seed of the run.

        Raises:
            ScenarioError: this version cannot read it.
        """

    @abstractmethod
    def metrics(self) -> dict[str, Any]:
        """Return the results; empty if the run did not get there."""

    @cached_property
    def ticks(self) -> Table:
        """Sensors and setpoints of every control tick.

        Raises:
            UsageError: here and for the other tables, the file is damaged or, in a run that ended,
                cut off.
        """
        return self._table("ticks")

    @cached_property
    def records(self) -> Table:
        """True state of the world and state of the walking engine, every 20 ms."""
        return self._table("records")

    @cached_property
    def frames(self) -> Table:
        """Detections, belief and decisions of every camera frame."""
        return self._table("frames")

    @cached_property
    def seconds(self) -> Table:
        """Hashes and saturation, every second."""
        return self._table("seconds")

    @cached_property
    def events(self) -> Table:
        """Events."""
        return self._table("events")

    @cached_property
    def images(self) -> Table:
        """Images of the head camera."""
        return self._table("images")

    def unit(self, column: str) -> str:
        """Return the unit of a column, for example of ``records.zmp``.

        Raises:
            UsageError: unknown table or column.
        """
        table, _, name = column.partition(".")
        if table not in TABLES:
            raise UsageError(f"unknown table {table!r}{suggestion(table, list(TABLES))}")
        unit: str = getattr(self, table).unit(name)
        return unit

    def to_pandas(self) -> dict[str, Any]:
        """Return all tables as pandas data frames by name; pandas must be installed."""
        return {name: getattr(self, name).to_pandas() for name in TABLES}

    @abstractmethod
    def _table(self, name: str) -> Table:
        """Return a table."""


@dataclass(frozen=True)
class MemoryRun(Run):
    """A run in memory.

    Attributes:
        simulated: scenario with the seed of the run.
        tables: all tables by name.
        results: metrics.
    """

    simulated: Scenario
    tables: Mapping[str, Table] = field(repr=False)
    results: dict[str, Any] = field(repr=False)

    def scenario(self) -> Scenario:
        """Return the scenario with the seed of the run."""
        return self.simulated

    def metrics(self) -> dict[str, Any]:
        """Return the results."""
        return self.results

    def _table(self, name: str) -> Table:
        return self.tables[name]
