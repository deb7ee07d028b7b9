"""Comparison of two sweeps, or two runs, on their common seeds."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from hsr8.errors import UsageError
from hsr8.files.tables import flatten
from hsr8.measure.registry import METRICS, Shown, shown_in
from hsr8.measure.statistics import PairedDifference, compare_successes, compare_values
from hsr8.recording.manifest import CALL
from hsr8.recording.run import open_run, run_folders
from hsr8.suggestion import suggestion
from hsr8.sweep.definition import (
    Definition,
    Differences,
    scenario_differences,
    version_differences,
)
from hsr8.sweep.folder import DEFINITION, SweepFolder
from hsr8.sweep.job import CRASHED, REFUSED, RunResult

SAME_WORLD = ("world.", "mission.")  # sections that must agree for seeds to pair
APPEARANCE = ("world.brightness", "world.beacons", "world.beacon_displacement")  # except these keys

Seed = int | str


@dataclass(frozen=True, slots=True)
class Side:
    """One side of the comparison.

    Attributes:
        name: folder of the sweep or the run, or name of the entry of a benchmark.
        text: scenario and versions, or suite and command, for people.
        runs: results by seed, or by family and seed, without refused runs.
        definition: scenario and versions; None of an entry.
    """

    name: str
    text: str
    runs: dict[Seed, RunResult]
    definition: Definition | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class MetricDifference(PairedDifference):
    """Difference of one metric over the seeds that have it on both sides.

    Attributes:
        metric: name.
        only_a, only_b: seeds on which only one side succeeded, for a proportion.
    """

    metric: str
    only_a: tuple[Seed, ...] = ()
    only_b: tuple[Seed, ...] = ()


@dataclass(frozen=True, slots=True)
class Comparison:
    """Differences between two sides.

    Attributes:
        a, b: the sides.
        seeds: common seeds.
        settings: keys of the scenario that differ, with both values as JSON.
        versions: versions and plugins that differ.
        metrics: one difference per metric that both sides have.
        families: difference of the success rate by family of a benchmark.
    """

    a: Side
    b: Side
    seeds: tuple[Seed, ...]
    settings: Differences
    versions: Differences
    metrics: tuple[MetricDifference, ...]
    families: dict[str, MetricDifference] = field(default_factory=dict)


def open_side(path: Path) -> Side:
    """Return the sweep or the run at `path`, or the newest run below it.

    Raises:
        UsageError: `path` is neither, or a run without results.
    """
    if _is_sweep(path):
        folder = SweepFolder.read(path)
        runs = {r["seed"]: flatten(r) for r in folder.results() if r["outcome"] != REFUSED}
        return _side(path, folder.definition, runs)
    parts = sorted(file.parent.name for file in path.glob(f"*/{DEFINITION}"))
    if parts or not path.is_dir() or not run_folders(path):
        hint = f"; expected one of its parts: {', '.join(parts)}" if parts else ""
        if not path.is_absolute() and (Path("sweeps") / path).is_dir():
            hint = f"; did you mean {Path('sweeps') / path}?"
        raise UsageError(f"{path}: not a folder of a sweep or a run{hint}")
    run = open_run(path)
    metrics = run.metrics
    if not metrics:
        raise UsageError(f"{path}: no results, the run did not end")
    try:
        scenario = run.scenario_text()
        tomllib.loads(scenario)
        definition = Definition(
            name=str(run.manifest["scenario"]),
            command_words=(str(run.manifest["command"]),),
            hsr8=str(run.manifest["hsr8"]),
            code=str(run.manifest["code"]),
            processor=str(run.manifest["machine"]).split(" ")[-1],
            libraries=dict(run.manifest["libraries"]),
            scenario=scenario,
        )
    except (KeyError, TypeError, ValueError) as error:
        raise UsageError(f"{path}: cannot read the run folder: {error}") from error
    return _side(run.folder, definition, {run.seed: {"seed": run.seed, **flatten(metrics)}})


def _side(path: Path, definition: Definition, runs: dict[Seed, RunResult]) -> Side:
    return Side(str(path), f"`{definition.name}`, {definition.made_with()}", runs, definition)


def _is_sweep(path: Path) -> bool:
    try:
        return (path / DEFINITION).exists()
    except OSError as error:
        raise UsageError(f"{path}: cannot read: {error.strerror}") from error


def compare(a: Side, b: Side, metrics: Sequence[str] = ()) -> Comparison:
    """Compare B with A, two sweeps or runs.

    Args:
        a: reference.
        b: side compared with it.
        metrics: names of metrics; by default those that the registry compares.

    Raises:
        UsageError: no seed is common, the worlds of a seed differ, or a metric is unknown.
    """
    assert a.definition is not None
    assert b.definition is not None
    settings = scenario_differences(a.definition, b.definition)
    worlds = [
        f"\n  {key}: {x} in A, {y} in B"
        for key, (x, y) in settings.items()
        if key.startswith(SAME_WORLD) and key not in APPEARANCE
    ]
    if worlds:
        raise UsageError("A and B have different worlds for the same seed:" + "".join(worlds))
    seeds = tuple(sorted(a.runs.keys() & b.runs.keys(), key=int))
    if not seeds:
        raise UsageError(f"no common seed: A has {_range(a.runs)}, B has {_range(b.runs)}")
    for metric in metrics:
        _require_metric(metric, [side.runs[seed] for side in (a, b) for seed in seeds])
    names = metrics or [metric.name for metric in shown_in(Shown.COMPARED)]
    differences = paired_differences(names, a.runs, b.runs, seeds)
    versions = version_differences(a.definition, b.definition)
    plugins = _plugin(a.definition), _plugin(b.definition)
    if plugins[0] != plugins[1]:
        versions["decisions"] = plugins
    return Comparison(a, b, seeds, settings, versions, differences)


def paired_differences(
    metrics: Sequence[str],
    a: Mapping[Any, RunResult],
    b: Mapping[Any, RunResult],
    seeds: Sequence[Seed],
) -> tuple[MetricDifference, ...]:
    """Return the difference B - A of every metric that both sides have.

    Args:
        metrics: names of metrics.
        a: results by seed.
        b: results by seed.
        seeds: common seeds.
    """
    differences = (_difference(metric, a, b, seeds) for metric in metrics)
    return tuple(d for d in differences if d is not None)


def _plugin(definition: Definition) -> str:
    """Return the call that ran user-defined objects; ``-`` for those of the scenario."""
    command = " ".join(definition.command_words)
    return command if command.startswith(CALL) else "-"


def _difference(
    metric: str, a: Mapping[Any, RunResult], b: Mapping[Any, RunResult], seeds: Sequence[Seed]
) -> MetricDifference | None:
    """Return None if no seed has the metric on both sides."""
    if metric in METRICS and METRICS[metric].successes:
        seeds = [s for s in seeds if a[s].get("success") and b[s].get("success")]
    pairs = {s: (_value(a[s], metric), _value(b[s], metric)) for s in seeds}
    pairs = {s: pair for s, pair in pairs.items() if None not in pair}
    if not pairs:
        return None
    if all(isinstance(value, bool) for pair in pairs.values() for value in pair):
        return MetricDifference(
            **asdict(compare_successes(*zip(*pairs.values(), strict=True))),
            metric=metric,
            only_a=tuple(seed for seed, (x, y) in pairs.items() if x and not y),
            only_b=tuple(seed for seed, (x, y) in pairs.items() if y and not x),
        )
    difference = compare_values(*np.array(list(pairs.values()), float).T)
    return MetricDifference(**asdict(difference), metric=metric)


def _value(run: RunResult, metric: str) -> Any:
    """Return a number or None; a crashed run is a failure, and its other metrics are unknown."""
    if metric == "success" and run.get("outcome") == CRASHED:
        return False
    value = run.get(metric)
    return value if isinstance(value, bool | int | float) and isfinite(value) else None


def _require_metric(metric: str, runs: Sequence[RunResult]) -> None:
    known = sorted(
        {key for run in runs for key in run if key != "seed" and _value(run, key) is not None}
    )
    if metric not in known:
        raise UsageError(
            f"--metric: unknown metric, got {metric}{suggestion(metric, known)}; expected one of "
            f"{', '.join(known)}"
        )


def _range(runs: Mapping[Seed, RunResult]) -> str:
    return f"{min(runs, key=int)} to {max(runs, key=int)}" if runs else "no runs"
