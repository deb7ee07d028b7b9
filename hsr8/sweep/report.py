"""The results of a sweep as a page of Markdown."""

from collections.abc import Mapping, Sequence
from typing import Any

from hsr8.files.tables import table
from hsr8.measure.registry import METRICS
from hsr8.recording.verdict import reason_of
from hsr8.sweep.definition import Definition
from hsr8.sweep.job import REFUSED, RunResult
from hsr8.sweep.summary import COUNTS, QUANTITIES, Summary, summarize, worst_first

MAX_LISTED = 20  # runs listed with their command line
MAX_TABLE = 200  # runs in the table of the page
COLUMNS = ("outcome", "success", *(m.name for m in (*COUNTS, *QUANTITIES)), "exit_reason")
MEDIANS = [METRICS[k] for k in ("min_clearance_m", "time_to_goal_s", "localization_rmse_m")]


def report(definition: Definition, results: Sequence[RunResult], command: str) -> str:
    """Return the page of one sweep; `command` repeats it."""
    summary = summarize(results)
    lines = [f"# `{definition.name}`: {_seeds(results)}", "", f"    {command}", ""]
    lines += [f"{definition.made_with()}.", ""]
    lines += table(("result", "(95 % interval)"), headline(summary))
    quantities = [
        (METRICS[key].head, str(d.n), *map(_number, (d.mean, d.median, d.p10, d.p90, d.min, d.max)))
        for key, d in summary.quantities.items()
    ]
    lines += table(("per run", "n", "mean", "median", "10 %", "90 %", "min", "max"), quantities)
    lines += _worst(definition, results)
    refused = [r for r in results if r["outcome"] == REFUSED]
    if refused:
        lines += ["## Refused", ""]
        lines += [f"- {r['seed']}: {_one_line(r.get('error'))}" for r in refused[:MAX_LISTED]]
        lines += [*_and_more(refused), ""]
    if 0 < len(results) <= MAX_TABLE:
        rows = [(str(r["seed"]), *(_cell(r.get(key)) for key in COLUMNS)) for r in results]
        lines += ["## Runs", "", *table(("seed", *COLUMNS), rows)]
    return "\n".join(lines)


def report_of_values(
    keys: str, summaries: Mapping[str, Summary], command: str, made_with: str
) -> str:
    """Return the page of a sweep over the values of `keys`: one line per value.

    Args:
        keys: varied keys of the scenario.
        summaries: summary by value.
        command: command line that repeats the sweep.
        made_with: versions.
    """
    head = ("value", "runs", "success", "95 %", "runs with a fall", "falls", "collisions per run")
    heads = (*head, "per metre", *(f"{metric.head}, median" for metric in MEDIANS))
    rows = [
        (
            f"`{value}`",
            str(s.runs),
            f"{s.success.fraction:.0%}",
            f"{s.success.low:.0%} to {s.success.high:.0%}",
            f"{s.fall.fraction:.0%}",
            str(s.counts["falls"]),
            _number(s.collisions_per_run),
            _number(s.collisions_per_m),
            *(_number(d.median) if (d := s.quantities.get(m.name)) else "" for m in MEDIANS),
        )
        for value, s in summaries.items()
    ]
    lines = [f"# Over `{keys}`", "", f"    {command}", "", f"{made_with}.", ""]
    return "\n".join([*lines, *table(heads, rows)])


def headline(summary: Summary) -> list[tuple[str, str]]:
    """Return the main results by label."""
    rates = _number(summary.collisions_per_run), _number(summary.collisions_per_m)
    lines = [
        ("success", str(summary.success)),
        ("criteria met", str(summary.criteria_met)),
        ("runs with a collision", str(summary.collision)),
        ("runs with a fall", str(summary.fall)),
        *((m.label, str(summary.counts[m.name])) for m in COUNTS),
        ("collisions per run, per metre", ", ".join(rates)),
    ]
    for name in ("spl", "optimal_time_ratio"):
        if (ratio := getattr(summary, name)) is not None:
            lines.append((METRICS[name].label, _number(ratio)))
    if summary.arrived.n:
        lines.append(("successes that arrive within 15 deg", str(summary.arrived)))
    reasons = ", ".join(f"{reason} {n}" for reason, n in summary.exit_reasons.items())
    lines.append(("exit reasons", reasons))
    counts = {
        "crashed": summary.crashed,
        "diverged": summary.diverged,
        "repeated after a crash": summary.repeated,
        "refused, see below": summary.refused,
    }
    return lines + [(label, str(count)) for label, count in counts.items() if count]


def problem(result: RunResult) -> str:
    """Return the problem of a run in a few words; empty for a good one."""
    if result["outcome"] not in ("passed", "failed"):
        return f"{result['outcome']}: {_one_line(result.get('error'))}"
    if not result.get("success"):
        return reason_of(result)
    return "criteria not met" if result["outcome"] == "failed" else ""


def _seeds(results: Sequence[RunResult]) -> str:
    seeds = [r["seed"] for r in results]
    if len(seeds) < 2:
        return f"seed {seeds[0]}" if seeds else "no runs yet"
    gaps = "" if max(seeds) - min(seeds) == len(seeds) - 1 else ", with gaps"
    return f"{len(seeds)} seeds, {min(seeds)} to {max(seeds)}{gaps}"


def _worst(definition: Definition, results: Sequence[RunResult]) -> list[str]:
    ranked = worst_first(results)
    bad = [r for r in ranked if problem(r)]
    lines = []
    for r in bad[:MAX_LISTED] or ranked[:3]:
        clearance = r.get("min_clearance_m")
        near = "" if clearance is None else f"clearance {_number(clearance)} m"
        text = "; ".join(filter(None, (problem(r), near)))
        lines += [f"- seed {r['seed']}: {text}", f"  `{definition.command(r['seed'])}`"]
    title = "## Worst runs" if bad else "## Smallest clearance"
    return [title, "", *lines, *_and_more(bad), ""] if lines else []


def _and_more(results: Sequence[RunResult]) -> list[str]:
    more = len(results) - MAX_LISTED
    return [f"- and {more} more"] if more > 0 else []


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None:
        return ""
    return _number(value) if isinstance(value, float) else str(value)


def _number(value: float) -> str:
    return f"{value:.3g}"


def _one_line(text: object) -> str:
    return str(text or "no message").strip().split("\n", 1)[0][:200]
