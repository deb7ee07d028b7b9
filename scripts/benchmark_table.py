"""Numbers of the result pages: rows of runs, and the columns of a table as functions of them."""

from collections.abc import Callable, Sequence
from functools import partial
from math import hypot
from statistics import fmean, median
from typing import Any

from hsr8.measure.statistics import Proportion, compare_successes, spl

Run = dict[str, Any]
NUMBERS = (
    *("collisions", "falls", "certified_time_s", "time_to_goal_s", "min_clearance_m"),
    *("head_travel_radps", "localization_rmse_m", "heading_rmse_deg", "nees_mean"),
    *("static_track_rmse_m", "mover_velocity_rmse_mps", "max_tilt_deg", "limited_fraction"),
    *("real_time_factor", "wall_time_s", "walk_tick_mean_ms"),
    "personal_space_intrusions",
)
"""Metrics of a run that the columns use, with these names."""
Column = Callable[[Sequence[Run], Sequence[Run]], str]
"""Text of a cell from its runs and those of the reference."""


def row(cell: Any, result: Run) -> Run:
    """Return the row of a run in the data of a page.

    Args:
        cell: cell of the run, a `benchmark_runs.Cell`.
        result: metrics of the run.
    """
    error = (result.get("velocity_error_rms") or {}).get("applied") or {}
    return {
        "arm": cell.arm,
        "level": cell.level,
        "scenario": cell.scenario,
        "seed": result["seed"],
        "outcome": result["outcome"],
        "success": bool(result.get("success")),
        "exit_reason": result.get("exit_reason") or "",
        "state_hash": (result.get("state_hash") or "")[:16],
        **{name: _number(result.get(name)) for name in NUMBERS},
        "velocity_error_mps": hypot(error["vx"], error["vy"]) if error else None,
    }


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, int | float) else None


def values(runs: Sequence[Run], name: str) -> list[float]:
    """Return the numbers of a metric that were measured."""
    return [run[name] for run in runs if run[name] is not None]


def pair(runs: Sequence[Run], others: Sequence[Run]) -> list[tuple[Run, Run]]:
    """Return the runs of two arms in the same worlds: those of `others` first."""
    known = {(run["scenario"], run["seed"]): run for run in others}
    keys = [(run["scenario"], run["seed"]) for run in runs]
    return [(known[k], run) for k, run in zip(keys, runs, strict=True) if k in known]


def _number_of(
    statistic: Callable[[list[float]], float],
    name: str,
    scale: float = 1.0,
    form: str = ".2f",
    unit: str = "",
) -> Column:
    """Return a column with a statistic of a metric; empty where it was not measured."""

    def text(runs: Sequence[Run], _: Sequence[Run]) -> str:
        numbers = values(runs, name)
        return f"{scale * statistic(numbers):{form}}{unit}" if numbers else ""

    return text


_median, _mean = partial(_number_of, median), partial(_number_of, fmean)


def _success(runs: Sequence[Run], _: Sequence[Run]) -> str:
    return proportion([run["success"] for run in runs])


def proportion(outcomes: Sequence[bool]) -> str:
    """Return for example ``97 of 100 (91–99 %)`` with a 95 % Wilson interval."""
    p = Proportion.counted(sum(outcomes), len(outcomes))
    return f"{p.count} of {p.n} ({100 * p.low:.0f}–{100 * p.high:.0f} %)"


def _count(test: Callable[[Run], bool]) -> Column:
    return lambda runs, _: f"{sum(map(test, runs))} of {len(runs)}"


def _spt(runs: Sequence[Run], _: Sequence[Run]) -> str:
    timed = [run for run in runs if run["certified_time_s"]]
    if not timed:
        return ""
    parts = [
        spl(run["success"], run["certified_time_s"], run["time_to_goal_s"] or 1e9) for run in timed
    ]
    return f"{100 * sum(parts) / len(parts):.0f} %"


def _time(runs: Sequence[Run], _: Sequence[Run]) -> str:
    times = values([run for run in runs if run["success"]], "time_to_goal_s")
    return f"{median(times):.0f}" if times else ""


def _difference(runs: Sequence[Run], reference: Sequence[Run]) -> str:
    pairs = pair(runs, reference)
    if not pairs or runs is reference:
        return ""
    difference = compare_successes(
        *zip(*((a["success"], b["success"]) for a, b in pairs), strict=True)
    )
    return difference.points()


def _equal(runs: Sequence[Run], reference: Sequence[Run]) -> str:
    pairs = pair(runs, reference) if runs is not reference else []
    if not pairs:
        return ""
    return f"{sum(a['state_hash'] == b['state_hash'] for a, b in pairs)} of {len(pairs)}"


COLUMNS: dict[str, tuple[str, Column]] = {
    "success": ("success, 95 % interval", _success),
    "difference": ("difference [points], p", _difference),
    "collided": ("with a collision", _count(lambda run: bool(run["collisions"]))),
    "falls": ("with a fall", _count(lambda run: bool(run["falls"]))),
    "ended": (
        "ran to the end",
        _count(lambda run: run["exit_reason"] in ("goal", "completed")),
    ),
    "survived": (
        "without a fall, 95 % interval",
        lambda runs, _: proportion([not run["falls"] for run in runs]),
    ),
    "spt": ("SPT", _spt),
    "clearance": ("min clearance, median [mm]", _median("min_clearance_m", 1e3, ".0f")),
    "time": ("time to goal, median [s]", _time),
    "head": ("head travel, median [rad/s]", _median("head_travel_radps")),
    "position": ("position RMSE, median", _median("localization_rmse_m", 1e3, ".1f", " mm")),
    "heading": ("heading RMSE, median [deg]", _median("heading_rmse_deg", 1.0, ".3f")),
    "nees": ("NEES / 3, mean", _mean("nees_mean")),
    "static_track": (
        "static tracks RMSE, median [mm]",
        _median("static_track_rmse_m", 1e3, ".1f"),
    ),
    "mover_velocity": (
        "mover velocity RMSE, median",
        _median("mover_velocity_rmse_mps", 1e2, ".1f", " cm/s"),
    ),
    "tilt": ("max tilt, median [deg]", _median("max_tilt_deg", 1.0, ".1f")),
    "velocity_error": (
        "velocity error RMS, median [cm/s]",
        _median("velocity_error_mps", 1e2, ".1f"),
    ),
    "intrusions": ("in personal space, mean", _mean("personal_space_intrusions")),
    "limited": ("limited ticks, median [1]", _median("limited_fraction")),
    "speed": ("speed over real time, median", _median("real_time_factor", 1.0, ".1f", " times")),
    "wall": ("wall time, median [s]", _median("wall_time_s", 1.0, ".1f")),
    "tick": ("walking tick, median of means [ms]", _median("walk_tick_mean_ms", 1.0, ".3f")),
    "crashed": (
        "crashed or diverged",
        _count(lambda run: run["outcome"] in ("crashed", "diverged")),
    ),
    "equal": ("equal hashes", _equal),
}
"""Heading and text of every column."""
