"""Comparisons of a reference with one or more arms: Markdown, LaTeX, CSV, JSON and a figure.

Holm's method corrects the p-values of all tests of a page together.
"""

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hsr8.files import atomic
from hsr8.files.tables import table
from hsr8.measure.statistics import holm
from hsr8.sweep.comparison import Comparison, MetricDifference, Seed

MAX_LISTED = 20  # seeds listed by number
MIN_PAIRS = 6  # below which neither an interval nor a test is stated
HEAD = ("metric", "n", "A", "B", "B - A", "95 % interval", "p", "p (Holm)", "test")
UNSTATED = "-"


@dataclass(frozen=True, slots=True)
class Line:
    """Difference of one metric between the reference and one arm.

    Attributes:
        arm: name of the arm.
        metric: the difference.
        corrected: p-value by Holm's method; None below `MIN_PAIRS`.
    """

    arm: str
    metric: MetricDifference
    corrected: float | None

    def cells(self) -> list[str]:
        """Return the cells of the line in a table, see `HEAD`."""
        metric = self.metric
        if metric.test == "McNemar":
            only = f"{len(metric.only_a)} in A only, {len(metric.only_b)} in B only"
            test = f"McNemar, exact; {only}"
            scaled = [100.0 * v for v in (metric.a, metric.b, metric.difference)]
            cells = [f"{scaled[0]:.1f} %", f"{scaled[1]:.1f} %", f"{scaled[2]:+.1f} points"]
            interval = f"{100 * metric.low:+.1f} to {100 * metric.high:+.1f}"
        else:
            test = "Wilcoxon, signed rank"
            cells = [f"{metric.a:.4g}", f"{metric.b:.4g}", f"{metric.difference:+.3g}"]
            interval = f"{metric.low:+.3g} to {metric.high:+.3g}"
        stated = [UNSTATED] * 3
        if self.corrected is not None:
            stated = [interval, f"{metric.p_value:.2g}", f"{self.corrected:.2g}"]
        return [f"`{metric.metric}`", str(metric.n), *cells, *stated, test]


def lines_of(comparisons: Sequence[Comparison]) -> list[Line]:
    """Return the differences of all arms, with corrected p-values."""
    lines = [Line(c.b.name, metric, None) for c in comparisons for metric in c.metrics]
    tested = [line for line in lines if line.metric.n >= MIN_PAIRS]
    corrected = dict(zip(map(id, tested), holm([t.metric.p_value for t in tested]), strict=True))
    return [Line(line.arm, line.metric, corrected.get(id(line))) for line in lines]


def page(comparisons: Sequence[Comparison], command: str) -> str:
    """Return the page in Markdown; `command` repeats the comparison."""
    texts = ["# Comparison", "", f"    {command}", ""]
    lines = iter(lines_of(comparisons))
    for comparison in comparisons:
        rows = [next(lines) for _ in comparison.metrics]
        texts += [*_about(comparison), *table(HEAD, (row.cells() for row in rows))]
        texts += _only_in_one(comparison.metrics)
    return "\n".join(texts)


def _about(comparison: Comparison) -> Iterator[str]:
    """Yield the heading of a comparison: sides, seeds, settings and families."""
    a, b, seeds = comparison.a, comparison.b, comparison.seeds
    more = [f"{len(side.runs) - len(seeds)} more in {name}" for name, side in (("A", a), ("B", b))]
    yield from ("## B against A", "")
    yield from (f"- {label}: `{side.name}`, {side.text}" for label, side in (("A", a), ("B", b)))
    common = f"{len(seeds)} common seeds, {seeds[0]} to {seeds[-1]}"
    if len(seeds) == 1:
        common = f"1 common seed, {seeds[0]}"
    yield from (f"- {common} ({', '.join(more)})", "")
    changed = {**comparison.settings, **comparison.versions}
    if changed:
        pairs = [(f"`{key}`", str(x), str(y)) for key, (x, y) in changed.items()]
        yield from table(("differs", "A", "B"), pairs)
    else:
        yield from ("Settings and versions are equal.", "")
    if comparison.families:
        rows = [
            (name, str(d.n), f"{100 * d.a:.1f} %", f"{100 * d.b:.1f} %", d.points())
            for name, d in comparison.families.items()
        ]
        yield from table(("success in", "n", "A", "B", "B - A [points], p (McNemar)"), rows)


def _only_in_one(metrics: Sequence[MetricDifference]) -> Iterator[str]:
    """Yield the seeds on which only one side succeeded."""
    for metric in metrics:
        for name, only in (("A", metric.only_a), ("B", metric.only_b)):
            if only:
                yield from (f"`{metric.metric}` in {name} only: {_seeds(only)}", "")


def _seeds(seeds: Sequence[Seed]) -> str:
    more = f" and {len(seeds) - MAX_LISTED} more" if len(seeds) > MAX_LISTED else ""
    return ", ".join(map(str, seeds[:MAX_LISTED])) + more


def latex(comparisons: Sequence[Comparison]) -> str:
    """Return one LaTeX table of all arms, for the package booktabs."""
    rows = [(line.arm, *line.cells()[:-1]) for line in lines_of(comparisons)]
    return tabular(("B", *HEAD[:-1]), rows, "ll" + "r" * (len(HEAD) - 2))


def tabular(head: Sequence[str], rows: Iterable[Sequence[str]], columns: str) -> str:
    """Return a LaTeX table for the package booktabs.

    Args:
        head: heads of the columns.
        rows: cells of every row.
        columns: alignment of the columns, such as ``lrr``.
    """
    first, *body = (" & ".join(map(_tex, cells)) for cells in (head, *rows))
    ends = "".join(f"{row} \\\\\n" for row in body)
    return (
        f"\\begin{{tabular}}{{{columns}}}\n\\toprule\n{first} \\\\\n\\midrule\n{ends}"
        "\\bottomrule\n\\end{tabular}\n"
    )


def _tex(cell: str) -> str:
    text = cell.replace("`", "").replace("\\", r"\textbackslash ")
    return "".join(f"\\{c}" if c in "&%$#_{}" else c for c in text)


def write_csv(comparisons: Sequence[Comparison], file: Path) -> None:
    """Write a line per arm and metric, with all numbers.

    Raises:
        OSError: the file cannot be written.
    """
    text = io.StringIO()
    names = ("metric", "test", "n", "a", "b", "difference", "low", "high", "p_value")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("reference", "arm", *names, "p_holm"))
    for line in lines_of(comparisons):
        values = asdict(line.metric)
        cells = [values[name] for name in names]
        writer.writerow((comparisons[0].a.name, line.arm, *cells, line.corrected))
    atomic.write_text(file, text.getvalue())


def draw(comparisons: Sequence[Comparison], file: Path) -> None:
    """Draw a forest plot: the difference of every metric and arm, with its interval.

    Raises:
        OSError: the file cannot be written.
    """
    from matplotlib.figure import Figure  # noqa: PLC0415  takes seconds

    lines = [line for line in lines_of(comparisons) if line.corrected is not None]
    names = list(dict.fromkeys(line.metric.metric for line in lines))
    arms = list(dict.fromkeys(line.arm for line in lines))
    height = 0.4 + 0.25 * (len(lines) + len(names))
    figure = Figure(figsize=(6.0, max(height, 1.0)), layout="constrained")
    axes = figure.subplots(max(len(names), 1), squeeze=False)[:, 0]
    for name, axis in zip(names, axes, strict=False):
        for line in (line for line in lines if line.metric.metric == name):
            m, y, k = line.metric, -arms.index(line.arm), arms.index(line.arm)
            axis.plot((m.low, m.high), (y, y), color=f"C{k}")
            axis.plot(m.difference, y, "o", color=f"C{k}")
        axis.axvline(0.0, color="0.5", linewidth=0.8)
        axis.set_yticks([-k for k in range(len(arms))], arms)
        axis.set_ylim(-len(arms) + 0.5, 0.5)
        axis.set_xlabel(f"{name}: difference from {comparisons[0].a.name}, 95 % interval")
    with atomic.draft(file) as new:
        figure.savefig(new)


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
