"""Pages of Markdown: one entry, and a table of several."""

from collections.abc import Sequence

from hsr8.errors import UsageError
from hsr8.evaluation.bench.comparison import compare_entries, require_same_suite
from hsr8.evaluation.bench.entry import ALL, Entry
from hsr8.evaluation.bench.suite import is_condition
from hsr8.evaluation.markdown import table
from hsr8.evaluation.proportion import Proportion
from hsr8.evaluation.registry import METRICS
from hsr8.evaluation.sweep.summary import Summary

MEDIANS = {"min_clearance_m": 3, "head_travel_radps": 2, "time_to_goal_s": 1}
"""Digits of the medians of a score."""
SCORES = [
    METRICS[name].head
    for name in ("collision", "timeout", "fall", "spl", "optimal_time_ratio", *MEDIANS)
]
SHOWN = ("hsr8", "code", "mujoco", "numpy", "scipy", "pin", "processor", "arithmetic")


def entry_page(entry: Entry) -> str:
    """Return the page of one entry: a line per family."""
    lines = [f"# {entry.name} in {_suite(entry)}, {entry.seeds} seeds", "", f"    {entry.command}"]
    lines += ["", f"{_versions(entry)}.", "", *_settings(entry)]
    head = ("family", "runs", "success", "95 % interval", *SCORES)
    rows = [
        (name, str(part.runs), *_success(part.success), *_cells(part))
        for name, part in entry.scores().items()
    ]
    return "\n".join([*lines, *table(head, rows)])


def entries_table(entries: Sequence[Entry]) -> list[str]:
    """Return the lines of a table with a line per entry, and the command of each.

    Args:
        entries: entries of one suite; the first is the reference of the paired differences.

    Raises:
        UsageError: the entries are not comparable.
    """
    first = entries[0]
    for entry in entries:
        require_same_suite(first, entry)
        if entry.seeds != first.seeds:
            raise UsageError(
                f"{entry.name}: other seeds, got {entry.seeds}; expected {first.seeds}"
            )
    families = list(first.runs)
    difference = f"difference from {first.name} [points], p"
    head = ("entry", "success", "95 % interval", difference, *families, *SCORES)
    rows = []
    for entry in entries:
        scores = entry.scores()
        pair = "" if entry is first else compare_entries(first, entry).metrics[0].points()
        counts = [f"{scores[f].success.count} of {scores[f].runs}" for f in families]
        whole = scores[ALL]
        rows.append((_name(entry), *_success(whole.success), pair, *counts, *_cells(whole)))
    lines = [f"{_suite(first)}, {first.seeds} seeds. {_versions(first)}.", "", *table(head, rows)]
    return lines + table(("entry", "command"), [(e.name, f"`{e.command}`") for e in entries])


def _suite(entry: Entry) -> str:
    return f"suite {entry.suite} {entry.suite_version} ({entry.suite_hash})"


def _versions(entry: Entry) -> str:
    known = [f"{name} {entry.versions[name]}" for name in SHOWN if entry.versions.get(name)]
    return ", ".join(known)


def _settings(entry: Entry) -> list[str]:
    if not entry.settings:
        return ["All settings are those of the standard.", ""]
    rows = [(f"`{key}`", old, new) for key, (old, new) in entry.settings.items()]
    return table(("setting", "standard", "entry"), rows)


def _name(entry: Entry) -> str:
    """Return the name of an entry, with the conditions that differ from the standard."""
    changed = [f"{key}={new}" for key, (_, new) in entry.settings.items() if is_condition(key)]
    return f"{entry.name} ({', '.join(changed)})".replace('"', "") if changed else entry.name


def _success(success: Proportion) -> tuple[str, str]:
    interval = f"{100 * success.low:.1f} to {100 * success.high:.1f} %"
    return f"{100 * success.fraction:.1f} %", interval


def _cells(part: Summary) -> list[str]:
    rates = [f"{100 * p.fraction:.1f}" for p in (part.collision, part.timeout, part.fall)]
    ratios = ["" if v is None else f"{v:.3f}" for v in (part.spl, part.optimal_time_ratio)]
    medians = [
        f"{part.quantities[key].median:.{digits}f}" if key in part.quantities else ""
        for key, digits in MEDIANS.items()
    ]
    return [*rates, *ratios, *medians]
