"""Comparison of two entries of a benchmark on the worlds that both walked."""

from hsr8.errors import UsageError
from hsr8.measure.registry import Shown, shown_in
from hsr8.sweep.bench.entry import Entry
from hsr8.sweep.comparison import Comparison, Seed, Side, paired_differences
from hsr8.sweep.definition import differences
from hsr8.sweep.job import REFUSED, RunResult
from hsr8.sweep.summary import scored

SAME = {"suite": "suite", "suite_version": "version", "suite_hash": "hash"}
"""Attributes of an entry that must agree, by their name in messages."""


def compare_entries(a: Entry, b: Entry) -> Comparison:
    """Compare B with A.

    Raises:
        UsageError: the suites differ, or no world is common.
    """
    for key, name in SAME.items():
        x, y = getattr(a, key), getattr(b, key)
        if x != y:
            raise UsageError(
                f"{b.name}: {name} of the suite differs, got {y}; expected {x} as {a.name}: "
                "only results of one version of a suite are comparable"
            )
    one, other = _side(a), _side(b)
    worlds = tuple(sorted(one.runs.keys() & other.runs.keys()))
    if not worlds:
        raise UsageError(f"no common world: A has {len(one.runs)}, B has {len(other.runs)}")
    for world in worlds:
        times = [side.runs[world]["certified_time_s"] for side in (one, other)]
        if None not in times and times[0] != times[1]:  # a crashed run has none
            raise UsageError(
                f"A and B have different worlds for {world}: certified_time_s is {times[0]} in A, "
                f"{times[1]} in B; repeat one with the version of the other"
            )
    metrics = [metric.name for metric in shown_in(Shown.BENCH_COMPARED)]
    standard = {key: old for e in (a, b) for key, (old, _) in e.settings.items()}
    settings = [standard | {key: new for key, (_, new) in e.settings.items()} for e in (a, b)]
    return Comparison(
        one,
        other,
        worlds,
        settings=differences(*settings),
        versions=differences(a.versions, b.versions),
        metrics=paired_differences(metrics, one.runs, other.runs, worlds),
        families={
            family: difference
            for family in a.runs
            for difference in paired_differences(
                ("success",),
                one.runs,
                other.runs,
                [world for world in worlds if str(world).rpartition(" ")[0] == family],
            )
        },
    )


def _side(entry: Entry) -> Side:
    """Return an entry as a side, with its runs by family and seed."""
    runs: dict[Seed, RunResult] = {
        f"{family} {run['seed']}": scored(run)
        for family, runs in entry.runs.items()
        for run in runs
        if run["outcome"] != REFUSED
    }
    suite = f"suite {entry.suite} {entry.suite_version} ({entry.suite_hash})"
    return Side(entry.name, f"{suite}, `{entry.command}`", runs)
