"""A comparison as a page of Markdown, and as plain values."""

from dataclasses import asdict
from typing import Any

from hsr8.evaluation.comparison import Comparison, Difference

NAMED = 20  # seeds that are named


def page(comparison: Comparison, command: str) -> str:
    """The page; `command` makes it again."""
    a, b, seeds = comparison.a, comparison.b, comparison.seeds
    alone = [f"{len(side.rows) - len(seeds)} more in {name}" for name, side in (("A", a), ("B", b))]
    lines = ["# B against A", "", f"    {command}", ""]
    lines += [f"- A: `{a.path}`, `{a.definition.name}`, {a.definition.made_with()}"]
    lines += [f"- B: `{b.path}`, `{b.definition.name}`, {b.definition.made_with()}"]
    lines += [f"- {len(seeds)} common seeds, {seeds[0]} to {seeds[-1]} ({', '.join(alone)})", ""]
    changed = {**comparison.settings, **comparison.versions}
    if changed:
        lines += ["| differs | A | B |", "|---|---|---|"]
        lines += [f"| `{key}` | {x} | {y} |" for key, (x, y) in changed.items()]
    else:
        lines += ["Scenario and versions are the same."]
    lines += ["", "| result | n | A | B | B - A | 95 % interval | p | test |", "|---" * 8 + "|"]
    lines += [_line(result) for result in comparison.results]
    for result in comparison.results:
        for name, which in (("A", result.only_a), ("B", result.only_b)):
            if which:
                lines += ["", f"`{result.metric}` in {name} only: {_seeds(which)}"]
    return "\n".join([*lines, ""])


def to_json(comparison: Comparison) -> dict[str, Any]:
    """Plain values by name."""
    return {
        "a": str(comparison.a.path),
        "b": str(comparison.b.path),
        "common_seeds": len(comparison.seeds),
        "seeds": list(comparison.seeds),
        "settings": {key: list(pair) for key, pair in comparison.settings.items()},
        "versions": {key: list(pair) for key, pair in comparison.versions.items()},
        "results": {result.metric: asdict(result) for result in comparison.results},
    }


def _line(result: Difference) -> str:
    if result.test == "McNemar":
        changed = f"McNemar, exact; {len(result.only_a)} in A only, {len(result.only_b)} in B only"
        cells = [
            f"{100 * result.a:.1f} %",
            f"{100 * result.b:.1f} %",
            f"{100 * result.difference:+.1f} points",
            f"{100 * result.low:+.1f} to {100 * result.high:+.1f}",
        ]
    else:
        changed = "Wilcoxon, signed rank"
        cells = [
            f"{result.a:.4g}",
            f"{result.b:.4g}",
            f"{result.difference:+.3g}",
            f"{result.low:+.3g} to {result.high:+.3g}",
        ]
    told = [f"`{result.metric}`", str(result.n), *cells, f"{result.p_value:.2g}", changed]
    return "| " + " | ".join(told) + " |"


def _seeds(seeds: tuple[int, ...]) -> str:
    more = f" and {len(seeds) - NAMED} more" if len(seeds) > NAMED else ""
    return ", ".join(map(str, seeds[:NAMED])) + more
