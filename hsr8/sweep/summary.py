"""Summary of the results of a sweep, or of a family of a benchmark."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import fsum, inf

import numpy as np

from hsr8.measure.registry import Shown, shown_in
from hsr8.measure.statistics import Proportion, mean, optimal_time_ratio, spl
from hsr8.sweep.job import CRASHED, REFUSED, RunResult

MAX_ARRIVAL_ERROR = 15.0  # heading error of an arrival [deg]

COUNTS = shown_in(Shown.COUNT)
QUANTITIES = shown_in(Shown.SWEEP | Shown.BENCH)


@dataclass(frozen=True, slots=True)
class Distribution:
    """Distribution of a quantity over runs, in its own unit."""

    n: int
    mean: float
    median: float
    p10: float
    p90: float
    min: float
    max: float

    @classmethod
    def of(cls, values: Sequence[float]) -> "Distribution":
        """Describe one or more values."""
        p10, median, p90 = np.quantile(values, (0.1, 0.5, 0.9)).tolist()
        mean = fsum(values) / len(values)
        return cls(len(values), mean, median, p10, p90, min(values), max(values))


@dataclass(frozen=True, slots=True)
class Summary:
    """Summary of runs.

    Attributes:
        runs: number of runs; crashed and diverged ones count as failures.
        refused: number of seeds without a run, for example without a valid world.
        crashed, diverged, repeated: number of runs.
        success: no collision, no fall, all via points passed, goal reached.
        criteria_met: the scenario's criteria hold.
        collision, timeout, fall: runs with at least one, of the runs that did not crash.
        arrived: successes within 15 deg of the arrival heading, where there is one.
        counts: falls and collisions in all runs that did not crash.
        collisions_per_run, collisions_per_m: rates in these runs [1], [1/m].
        spl: success weighted by path length, mean of all runs [1]; None without runs.
        optimal_time_ratio: success times certified over actual time, mean of all runs [1].
        exit_reasons: number of runs by exit reason.
        quantities: distribution by name; times are those of the successes.
    """

    runs: int
    refused: int
    crashed: int
    diverged: int
    repeated: int
    success: Proportion
    criteria_met: Proportion
    collision: Proportion
    timeout: Proportion
    fall: Proportion
    arrived: Proportion
    counts: dict[str, int]
    collisions_per_run: float
    collisions_per_m: float
    spl: float | None
    optimal_time_ratio: float | None
    exit_reasons: dict[str, int]
    quantities: dict[str, Distribution]


def summarize(results: Sequence[RunResult]) -> Summary:
    """Summarize the results of runs."""
    counted = [scored(r) for r in results if r["outcome"] != REFUSED]
    complete = [r for r in counted if r["outcome"] != CRASHED]
    successes = [r for r in complete if r["success"]]
    arrival_errors = measured(successes, "arrival_error_deg")
    metres = fsum(measured(complete, "path_length_m"))

    def proportion(runs: Sequence[RunResult], test: Callable[[RunResult], bool]) -> Proportion:
        return Proportion.counted(sum(map(test, runs)), len(runs))

    counts = {m.name: sum(int(r.get(m.name) or 0) for r in complete) for m in COUNTS}
    return Summary(
        runs=len(counted),
        refused=len(results) - len(counted),
        crashed=len(counted) - len(complete),
        diverged=sum(r["outcome"] == "diverged" for r in complete),
        repeated=sum(int(r.get("attempts", 1)) > 1 for r in counted),
        success=proportion(counted, lambda r: r["success"]),
        criteria_met=proportion(counted, lambda r: r["outcome"] == "passed"),
        collision=proportion(complete, lambda r: r["collision"]),
        timeout=proportion(complete, lambda r: r["timeout"]),
        fall=proportion(complete, lambda r: r["fall"]),
        arrived=Proportion.counted(
            sum(error <= MAX_ARRIVAL_ERROR for error in arrival_errors), len(arrival_errors)
        ),
        counts=counts,
        collisions_per_run=counts["collisions"] / len(complete) if complete else 0.0,
        collisions_per_m=counts["collisions"] / metres if metres else 0.0,
        spl=mean(measured(counted, "spl")),
        optimal_time_ratio=mean(measured(counted, "optimal_time_ratio")),
        exit_reasons=dict(
            Counter(str(r.get("exit_reason") or r["outcome"]) for r in counted).most_common()
        ),
        quantities={
            metric.name: Distribution.of(values)
            for metric in QUANTITIES
            if (values := measured(successes if metric.successes else complete, metric.name))
        },
    )


def scored(result: RunResult) -> RunResult:
    """Return the result of a run with success, rates and ratios.

    A crashed run is a failure without ``collision``, ``timeout`` and ``fall``. A success in a
    world without a certified path has neither ``spl`` nor ``optimal_time_ratio``.
    """
    crashed = result["outcome"] == CRASHED
    success = not crashed and bool(result.get("success"))
    ratios: dict[str, float | None] = {
        "spl": _ratio(spl, result, "certified_length_m", "path_length_m"),
        "optimal_time_ratio": _ratio(
            optimal_time_ratio, result, "certified_time_s", "time_to_goal_s"
        ),
    }
    if not success:
        ratios = dict.fromkeys(ratios, 0.0)
    rates = {
        "collision": bool(result.get("collisions")),
        "timeout": result.get("exit_reason") == "timeout",
        "fall": bool(result.get("falls")),
    }
    return {**result, "success": success, **ratios, **({} if crashed else rates)}


def _ratio(
    measure: Callable[[bool, float, float], float], result: RunResult, shortest: str, actual: str
) -> float | None:
    """Return a measure of a success; None if a metric is missing."""
    if result.get(shortest) is None or result.get(actual) is None:
        return None
    return measure(True, result[shortest], result[actual])


def worst_first(results: Sequence[RunResult]) -> list[RunResult]:
    """Sort: crashed, diverged, falls, most collisions, other failures, smallest clearance."""

    def badness(r: RunResult) -> tuple[float, ...]:
        clearance, time = r.get("min_clearance_m"), r.get("time_to_goal_s")
        return (
            {CRASHED: -2, "diverged": -1}.get(r["outcome"], 0),
            -int(r.get("falls") or 0),
            -int(r.get("collisions") or 0),
            bool(r.get("success")),
            r["outcome"] == "passed",
            inf if clearance is None else clearance,
            0.0 if time is None else -time,
            r["seed"],
        )

    return sorted((r for r in results if r["outcome"] != REFUSED), key=badness)


def measured(results: Sequence[RunResult], key: str) -> list[float]:
    """Return the values of a metric in the runs that have it."""
    return [float(r[key]) for r in results if r.get(key) is not None]
