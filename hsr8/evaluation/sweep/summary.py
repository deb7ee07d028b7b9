"""What the runs of a sweep come to."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from math import fsum
from typing import Any

import numpy as np

from hsr8.evaluation.sweep.job import CRASHED, REFUSED, Row
from hsr8.evaluation.wilson import wilson

ARRIVED = 15.0  # heading error of a good arrival at most [deg]
SEVERITY = ("failed", "diverged", CRASHED)

# Result, and whether only runs that succeeded count: a time to the goal needs a goal.
QUANTITIES: tuple[tuple[str, bool], ...] = (
    ("min_clearance_m", False),
    ("time_to_goal_s", True),
    ("arrival_error_deg", True),
    ("path_length_m", True),
    ("localization_rmse_m", False),
    ("heading_rmse_deg", False),
    ("nees_mean", False),
    ("obstacle_speed_rmse_mps", False),
    ("lost_fraction", False),
    ("time_standing_s", False),
    ("max_tilt_deg", False),
    ("saccades_per_s", False),
    ("head_travel_radps", False),
    ("real_time_factor", False),
)
COUNTS = (
    "collisions",
    "collisions_moving",
    "collisions_static",
    "collisions_at_fault",
    "falls",
    "attempts",
    "via_points_missed",
)
NUMBERS = (*COUNTS, *(key for key, _ in QUANTITIES))  # what is reckoned with


@dataclass(frozen=True, slots=True)
class Share:
    """A share that was counted, with its 95 % Wilson interval."""

    count: int
    of: int
    share: float
    low: float
    high: float

    @classmethod
    def counted(cls, count: int, of: int) -> "Share":
        """So many of so many."""
        return cls(count, of, count / of if of else 0.0, *wilson(count, of))


@dataclass(frozen=True, slots=True)
class Spread:
    """A quantity over the runs that have it, in its own unit."""

    n: int
    mean: float
    median: float
    p10: float
    p90: float
    least: float
    most: float

    @classmethod
    def of(cls, values: Sequence[float]) -> "Spread":
        """Of one or more values."""
        p10, median, p90 = np.quantile(values, (0.1, 0.5, 0.9)).tolist()
        mean = fsum(values) / len(values)
        return cls(len(values), mean, median, p10, p90, min(values), max(values))


@dataclass(frozen=True, slots=True)
class Summary:
    """Results of a sweep.

    Attributes:
        runs: runs that count; a crashed or diverged one is a failure.
        refused: seeds that could not be run, because no world was found for them for
            example; they do not count.
        crashed, diverged, retried: number of runs.
        success: no contact, no fall, all points passed, the goal reached.
        passed: met the scenario's criteria.
        without_collision, without_fall: of the runs that did not crash.
        arrived: of the successes that have an arrival heading, within 15 deg of it.
        collisions: in all; with movers, with standing obstacles, closed by the robot.
        collisions_per_run, collisions_per_metre: of the runs that did not crash.
        falls: in all.
        ended: runs by what ended them.
        quantities: by the name of the result.
    """

    runs: int
    refused: int
    crashed: int
    diverged: int
    retried: int
    success: Share
    passed: Share
    without_collision: Share
    without_fall: Share
    arrived: Share
    collisions: dict[str, int]
    collisions_per_run: float
    collisions_per_metre: float
    falls: int
    ended: dict[str, int]
    quantities: dict[str, Spread]

    def to_json(self) -> dict[str, Any]:
        """Plain values by name."""
        return asdict(self)


def summarize(rows: Sequence[Row]) -> Summary:
    """Sum up the rows of a sweep."""
    counted = [row for row in rows if row["outcome"] != REFUSED]
    whole = [row for row in counted if row["outcome"] != CRASHED]
    good = [row for row in whole if row.get("success")]
    arrivals = [
        row["arrival_error_deg"] for row in good if row.get("arrival_error_deg") is not None
    ]
    collisions = sum(int(row.get("collisions", 0)) for row in whole)
    metres = fsum(float(row.get("path_length_m") or 0.0) for row in whole)

    def share(of: Sequence[Row], test: Callable[[Row], bool]) -> Share:
        return Share.counted(sum(map(test, of)), len(of))

    def total(key: str) -> int:
        return sum(int(row.get(key) or 0) for row in whole)

    return Summary(
        runs=len(counted),
        refused=len(rows) - len(counted),
        crashed=len(counted) - len(whole),
        diverged=sum(row["outcome"] == "diverged" for row in whole),
        retried=sum(int(row.get("attempts", 1)) > 1 for row in counted),
        success=share(counted, lambda row: bool(row.get("success"))),
        passed=share(counted, lambda row: row["outcome"] == "passed"),
        without_collision=share(whole, lambda row: row.get("collisions") == 0),
        without_fall=share(whole, lambda row: row.get("falls") == 0),
        arrived=Share.counted(sum(error <= ARRIVED for error in arrivals), len(arrivals)),
        collisions={
            "all": collisions,
            "moving": total("collisions_moving"),
            "static": total("collisions_static"),
            "closing": total("collisions_at_fault"),
        },
        collisions_per_run=collisions / len(whole) if whole else 0.0,
        collisions_per_metre=collisions / metres if metres else 0.0,
        falls=total("falls"),
        ended=dict(
            Counter(str(row.get("exit_reason", row["outcome"])) for row in counted).most_common()
        ),
        quantities={
            key: Spread.of(values)
            for key, needs_success in QUANTITIES
            if (values := _values(good if needs_success else whole, key))
        },
    )


def worst_first(rows: Sequence[Row]) -> list[Row]:
    """Crashed and diverged runs, falls, most collisions, other failures, closest shaves."""

    def badness(row: Row) -> tuple[float, ...]:
        outcome = row["outcome"]
        clearance, time = row.get("min_clearance_m"), row.get("time_to_goal_s")
        return (
            -SEVERITY.index(outcome) if outcome in SEVERITY[1:] else 0,
            -int(row.get("falls") or 0),
            -int(row.get("collisions") or 0),
            bool(row.get("success")),
            outcome == "passed",
            clearance if clearance is not None else float("inf"),
            -time if time is not None else 0.0,
            row["seed"],
        )

    return sorted((row for row in rows if row["outcome"] != REFUSED), key=badness)


def _values(rows: Sequence[Row], key: str) -> list[float]:
    return [float(row[key]) for row in rows if row.get(key) is not None]
