"""Score of an entry in one family or in all."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from hsr8.evaluation.efficiency import optimal_time_ratio, spl
from hsr8.evaluation.proportion import Proportion
from hsr8.evaluation.registry import Shown, shown_in
from hsr8.evaluation.sums import mean
from hsr8.evaluation.sweep.job import CRASHED, REFUSED, RunResult
from hsr8.evaluation.sweep.summary import Distribution, distributions, measured


@dataclass(frozen=True, slots=True)
class Score:
    """Score of runs.

    Attributes:
        runs: number of runs; crashed and diverged ones count as failures.
        refused: number of seeds without a run, for example without a valid world.
        success: of all runs.
        collision: runs with at least one collision, of the runs that did not crash.
        timeout, fall: of the runs that did not crash.
        spl: success weighted by path length, mean of all runs [1]; None without runs.
        optimal_time_ratio: success times certified over actual time, mean of all runs [1].
        quantities: distribution of the metrics of a score; times are those of the successes.
    """

    runs: int
    refused: int
    success: Proportion
    collision: Proportion
    timeout: Proportion
    fall: Proportion
    spl: float | None
    optimal_time_ratio: float | None
    quantities: dict[str, Distribution]

    def to_json(self) -> dict[str, Any]:
        """Return plain values by name."""
        return asdict(self)


def score(results: Sequence[RunResult]) -> Score:
    """Return the score of runs with the metrics of a sweep."""
    runs = [scored(r) for r in results if r["outcome"] != REFUSED]
    complete = [r for r in runs if r["outcome"] != CRASHED]

    def proportion(of: Sequence[RunResult], test: Callable[[RunResult], Any]) -> Proportion:
        return Proportion.counted(sum(bool(test(r)) for r in of), len(of))

    return Score(
        runs=len(runs),
        refused=len(results) - len(runs),
        success=proportion(runs, lambda r: r["success"]),
        collision=proportion(complete, lambda r: r["collision"]),
        timeout=proportion(complete, lambda r: r["timeout"]),
        fall=proportion(complete, lambda r: r["fall"]),
        spl=mean(measured(runs, "spl")),
        optimal_time_ratio=mean(measured(runs, "optimal_time_ratio")),
        quantities=distributions(shown_in(Shown.BENCH), complete),
    )


def scored(result: RunResult) -> RunResult:
    """Return the result of a run with the quantities of a score.

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
