"""Comparison of two entries of a benchmark on the worlds that both walked."""

from dataclasses import asdict, dataclass
from typing import Any

from hsr8.errors import UsageError
from hsr8.evaluation.bench.entry import ALL, Entry
from hsr8.evaluation.bench.score import scored
from hsr8.evaluation.comparison import MetricDifference, paired_differences
from hsr8.evaluation.registry import Shown, shown_in
from hsr8.evaluation.sweep.job import REFUSED, RunResult

SAME = {"suite": "suite", "suite_version": "version", "suite_hash": "hash"}
"""Attributes of an entry that must agree, by their name in messages."""


@dataclass(frozen=True, slots=True)
class EntryComparison:
    """Differences between two entries.

    Attributes:
        a, b: the entries.
        worlds: common worlds, as family and seed.
        families: difference of the success rate by family.
        metrics: differences of all metrics over all families.
    """

    a: Entry
    b: Entry
    worlds: tuple[str, ...]
    families: dict[str, MetricDifference]
    metrics: tuple[MetricDifference, ...]

    def to_json(self) -> dict[str, Any]:
        """Return plain values by name."""
        return {
            "a": self.a.name,
            "b": self.b.name,
            "suite": self.a.suite,
            "suite_version": self.a.suite_version,
            "suite_hash": self.a.suite_hash,
            "worlds": list(self.worlds),
            "differs": {key: list(pair) for key, pair in differing(self.a, self.b).items()},
            "families": {name: asdict(part) for name, part in self.families.items()},
            ALL: {metric.metric: asdict(metric) for metric in self.metrics},
        }


def compare_entries(a: Entry, b: Entry) -> EntryComparison:
    """Compare B with A.

    Raises:
        UsageError: the suites differ, or no world is common.
    """
    require_same_suite(a, b)
    one, other = _runs(a), _runs(b)
    worlds = tuple(sorted(one.keys() & other.keys()))
    if not worlds:
        raise UsageError(f"no common world: A has {len(one)}, B has {len(other)}")
    for world in worlds:
        times = one[world]["certified_time_s"], other[world]["certified_time_s"]
        if None not in times and times[0] != times[1]:  # a crashed run has none
            raise UsageError(
                f"A and B have different worlds for {world}: certified_time_s is {times[0]} in A, "
                f"{times[1]} in B; repeat one with the version of the other"
            )
    families: dict[str, MetricDifference] = {}
    for family in a.runs:
        own = [world for world in worlds if world.rpartition(" ")[0] == family]
        for difference in paired_differences(("success",), one, other, own):
            families[family] = difference
    metrics = [metric.name for metric in shown_in(Shown.BENCH_COMPARED)]
    return EntryComparison(a, b, worlds, families, paired_differences(metrics, one, other, worlds))


def require_same_suite(a: Entry, b: Entry) -> None:
    """Check that two entries are comparable.

    Raises:
        UsageError: they are entries of different suites.
    """
    for key, name in SAME.items():
        x, y = getattr(a, key), getattr(b, key)
        if x != y:
            raise UsageError(
                f"{b.name}: {name} of the suite differs, got {y}; expected {x} as {a.name}: "
                "only results of one version of a suite are comparable"
            )


def differing(a: Entry, b: Entry) -> dict[str, tuple[str, str]]:
    """Return the settings and versions that differ, with both values; absent is ``-``."""
    sides = [{**e.versions, **{key: new for key, (_, new) in e.settings.items()}} for e in (a, b)]
    standard = {key: old for e in (a, b) for key, (old, _) in e.settings.items()}
    keys = dict.fromkeys(key for side in sides for key in side)
    pairs = {key: tuple(side.get(key, standard.get(key, "-")) for side in sides) for key in keys}
    return {key: (x, y) for key, (x, y) in pairs.items() if x != y}


def _runs(entry: Entry) -> dict[str, RunResult]:
    """Return the runs of an entry by family and seed."""
    return {
        f"{family} {run['seed']}": scored(run)
        for family, runs in entry.runs.items()
        for run in runs
        if run["outcome"] != REFUSED
    }
