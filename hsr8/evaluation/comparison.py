"""Two sweeps, or two runs, on the seeds that they have in common."""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from hsr8.errors import UsageError
from hsr8.evaluation.mcnemar import PairedShares
from hsr8.evaluation.paired import compare_paired
from hsr8.evaluation.sweep.definition import Definition, differences, version_differences
from hsr8.evaluation.sweep.folder import DEFINITION, SweepFolder
from hsr8.evaluation.sweep.job import CRASHED, REFUSED, Row
from hsr8.evaluation.sweep.table import flat
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import OWN
from hsr8.recorder.run.run_reader import open_run
from hsr8.suggestion import suggestion

METRICS = (
    "success",
    "collisions",
    "falls",
    "min_clearance_m",
    "time_to_goal_s",
    "arrival_error_deg",
    "path_length_m",
    "localization_rmse_m",
    "heading_rmse_deg",
    "nees_mean",
    "head_travel_radps",
)
ON_ARRIVAL = ("time_to_goal_s", "arrival_error_deg", "path_length_m")  # where both succeeded
SAME_WORLD = ("world.", "mission.")  # seeds pair only if these sections agree
LOOKS = ("world.brightness", "world.beacons", "world.beacon_displacement")  # but for these keys


@dataclass(frozen=True, slots=True)
class Side:
    """One of the two.

    Attributes:
        path: of its folder.
        definition: what its runs have in common.
        rows: results by seed; seeds that could not be run are left out.
    """

    path: Path
    definition: Definition
    rows: dict[int, Row]


@dataclass(frozen=True, slots=True)
class Difference:
    """One result, B against A.

    Attributes:
        metric: its name.
        test: "McNemar" for shares, else "Wilcoxon".
        n: seeds on which both have it.
        a, b: share or mean.
        difference: of b from a.
        low, high: its 95 % interval.
        p_value: two-sided.
        only_a, only_b: of a share, seeds at which only one of them succeeded.
    """

    metric: str
    test: str
    n: int
    a: float
    b: float
    difference: float
    low: float
    high: float
    p_value: float
    only_a: tuple[int, ...] = ()
    only_b: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Comparison:
    """Everything that differs.

    Attributes:
        a, b: the two.
        seeds: that both have.
        settings: keys of the scenario that differ, with both values as JSON.
        versions: that differ, and decisions of one's own.
        results: one per metric that both have.
    """

    a: Side
    b: Side
    seeds: tuple[int, ...]
    settings: dict[str, tuple[str, str]]
    versions: dict[str, tuple[str, str]]
    results: tuple[Difference, ...]


def open_side(path: Path) -> Side:
    """The sweep or the run at `path`, or the newest run below it.

    Raises:
        UsageError: there is neither.
    """
    if _is_sweep(path):
        folder = SweepFolder.read(path)
        rows = {row["seed"]: flat(row) for row in folder.rows() if row["outcome"] != REFUSED}
        return Side(path, folder.definition, rows)
    parts = sorted(file.parent.name for file in path.glob(f"*/{DEFINITION}"))
    if parts or not any(path.glob(f"**/{run_folder.MANIFEST}")):
        hint = f": give one of its parts, {', '.join(parts)}" if parts else ""
        if not path.is_absolute() and (Path("sweeps") / path).is_dir():
            hint = f"; did you mean {Path('sweeps') / path}?"
        raise UsageError(f"{path} is neither a sweep's folder nor a run folder{hint}")
    run = open_run(path)
    metrics = run.metrics()
    if not metrics:
        raise UsageError(f"{path} has no results: the run did not end")
    try:
        scenario = run.scenario_text()
        tomllib.loads(scenario)
        definition = Definition(
            name=str(run.manifest["scenario"]),
            again=(str(run.manifest["command"]),),
            hsr8=str(run.manifest["hsr8"]),
            code="",
            processor=str(run.manifest["machine"]).split(" ")[-1],
            libraries=dict(run.manifest["libraries"]),
            scenario=scenario,
        )
    except (KeyError, TypeError, ValueError) as error:
        raise UsageError(f"cannot read the run folder {path}: {error}") from error
    return Side(run.path, definition, {run.seed: {"seed": run.seed, **flat(metrics)}})


def _is_sweep(path: Path) -> bool:
    try:
        return (path / DEFINITION).exists()
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from error


def compare(a: Side, b: Side, metrics: Sequence[str] = ()) -> Comparison:
    """Compare B with A.

    Args:
        a: what is there.
        b: what it is compared with.
        metrics: names of results; the usual ones by default.

    Raises:
        UsageError: no seed is common, the same seed is not the same world, or a metric is
            unknown.
    """
    settings = differences(a.definition, b.definition)
    worlds = {
        key: pair
        for key, pair in settings.items()
        if key.startswith(SAME_WORLD) and key not in LOOKS
    }
    if worlds:
        raise UsageError(
            "the same seed is not the same world in both:"
            + "".join(f"\n  {key}: {x} in A, {y} in B" for key, (x, y) in worlds.items())
        )
    seeds = tuple(sorted(a.rows.keys() & b.rows.keys()))
    if not seeds:
        raise UsageError(f"no seed is in both: A has {_range(a.rows)}, B has {_range(b.rows)}")
    for metric in metrics:
        _must_know(metric, [a.rows[seed] for seed in seeds] + [b.rows[seed] for seed in seeds])
    found = (_compared(metric, a, b, seeds) for metric in metrics or METRICS)
    versions = version_differences(a.definition, b.definition)
    if not (a.definition.code and b.definition.code):  # a run folder does not know
        versions.pop("code", None)
    own = _own(a), _own(b)
    if own[0] != own[1]:
        versions["decisions"] = own
    return Comparison(a, b, seeds, settings, versions, tuple(d for d in found if d is not None))


def _own(side: Side) -> str:
    """The call that names a planner or a gaze of one's own; ``-`` for the scenario's."""
    command = " ".join(side.definition.again)
    return command if command.startswith(OWN) else "-"


def _compared(metric: str, a: Side, b: Side, seeds: Sequence[int]) -> Difference | None:
    """None if no seed has it in both."""
    if metric in ON_ARRIVAL:
        seeds = [s for s in seeds if a.rows[s].get("success") and b.rows[s].get("success")]
    pairs = {s: (_value(a.rows[s], metric), _value(b.rows[s], metric)) for s in seeds}
    both = {s: pair for s, pair in pairs.items() if None not in pair}
    if not both:
        return None
    if all(isinstance(value, bool) for pair in both.values() for value in pair):
        return _shares(metric, both)
    x, y = np.array(list(both.values()), float).T
    d = compare_paired(x, y)
    return Difference(metric, "Wilcoxon", d.n, d.mean_a, d.mean_b, d.mean, d.low, d.high, d.p_value)


def _shares(metric: str, pairs: dict[int, tuple[bool, bool]]) -> Difference:
    counts = PairedShares.count([x for x, _ in pairs.values()], [y for _, y in pairs.values()])
    low, high = counts.interval()
    return Difference(
        metric,
        "McNemar",
        counts.n,
        (counts.both + counts.only_a) / counts.n,
        (counts.both + counts.only_b) / counts.n,
        counts.difference,
        low,
        high,
        counts.p_value(),
        tuple(seed for seed, (x, y) in pairs.items() if x and not y),
        tuple(seed for seed, (x, y) in pairs.items() if y and not x),
    )


def _value(row: Row, metric: str) -> Any:
    """A crashed run has not succeeded; what else it would have come to is unknown."""
    if metric == "success" and row.get("outcome") == CRASHED:
        return False
    value = row.get(metric)
    return value if isinstance(value, bool | int | float) and isfinite(value) else None


def _must_know(metric: str, rows: Sequence[Row]) -> None:
    known = sorted(
        {key for row in rows for key in row if key != "seed" and _value(row, key) is not None}
    )
    if metric not in known:
        raise UsageError(
            f"--metric {metric}: no run has such a number{suggestion(metric, known)} "
            f"(there are: {', '.join(known)})"
        )


def _range(rows: dict[int, Row]) -> str:
    return f"{min(rows)} to {max(rows)}" if rows else "no runs"
