"""A comparison as a page of Markdown, and as plain values."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from hsr8.evaluation.comparison import Comparison, MetricDifference, Seed
from hsr8.evaluation.markdown import table

MAX_LISTED = 20  # seeds listed by number


def page(comparison: Comparison, command: str) -> str:
    """Return the page; `command` repeats the comparison."""
    a, b, seeds = comparison.a, comparison.b, comparison.seeds
    more = [f"{len(side.runs) - len(seeds)} more in {name}" for name, side in (("A", a), ("B", b))]
    lines = ["# B against A", "", f"    {command}", ""]
    lines += [f"- {label}: `{side.name}`, {side.text}" for label, side in (("A", a), ("B", b))]
    lines += [f"- {len(seeds)} common seeds, {seeds[0]} to {seeds[-1]} ({', '.join(more)})", ""]
    changed = {**comparison.settings, **comparison.versions}
    if changed:
        pairs = [(f"`{key}`", str(x), str(y)) for key, (x, y) in changed.items()]
        lines += table(("differs", "A", "B"), pairs)
    else:
        lines += ["Settings and versions are equal.", ""]
    if comparison.families:
        rows = [
            (name, str(d.n), f"{100 * d.a:.1f} %", f"{100 * d.b:.1f} %", d.points())
            for name, d in comparison.families.items()
        ]
        lines += table(("success in", "n", "A", "B", "B - A [points], p (McNemar)"), rows)
    return "\n".join([*lines, *difference_table(comparison.metrics)])


def difference_table(metrics: Sequence[MetricDifference]) -> list[str]:
    """Return the lines of a table of differences, and the seeds of only one side."""
    head = ("metric", "n", "A", "B", "B - A", "95 % interval", "p", "test")
    lines = table(head, map(_row, metrics))
    for metric in metrics:
        for name, only in (("A", metric.only_a), ("B", metric.only_b)):
            if only:
                lines += [f"`{metric.metric}` in {name} only: {_seeds(only)}", ""]
    return lines


def to_json(comparison: Comparison) -> dict[str, Any]:
    """Return plain values by name."""
    return {
        "a": comparison.a.name,
        "b": comparison.b.name,
        "common_seeds": len(comparison.seeds),
        "seeds": list(comparison.seeds),
        "settings": {key: list(pair) for key, pair in comparison.settings.items()},
        "versions": {key: list(pair) for key, pair in comparison.versions.items()},
        "families": {name: asdict(part) for name, part in comparison.families.items()},
        "results": {metric.metric: asdict(metric) for metric in comparison.metrics},
    }


def _row(metric: MetricDifference) -> list[str]:
    if metric.test == "McNemar":
        test = f"McNemar, exact; {len(metric.only_a)} in A only, {len(metric.only_b)} in B only"
        cells = [
            f"{100 * metric.a:.1f} %",
            f"{100 * metric.b:.1f} %",
            f"{100 * metric.difference:+.1f} points",
            f"{100 * metric.low:+.1f} to {100 * metric.high:+.1f}",
        ]
    else:
        test = "Wilcoxon, signed rank"
        cells = [
            f"{metric.a:.4g}",
            f"{metric.b:.4g}",
            f"{metric.difference:+.3g}",
            f"{metric.low:+.3g} to {metric.high:+.3g}",
        ]
    return [f"`{metric.metric}`", str(metric.n), *cells, f"{metric.p_value:.2g}", test]


def _seeds(seeds: Sequence[Seed]) -> str:
    more = f" and {len(seeds) - MAX_LISTED} more" if len(seeds) > MAX_LISTED else ""
    return ", ".join(map(str, seeds[:MAX_LISTED])) + more
