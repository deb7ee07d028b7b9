"""The results of a sweep as a page of Markdown."""

from collections.abc import Mapping, Sequence
from typing import Any

from hsr8.evaluation.sweep.definition import Definition
from hsr8.evaluation.sweep.job import REFUSED, Row
from hsr8.evaluation.sweep.summary import Share, Summary, summarize, worst_first

WORST = 20  # runs told with their command line
TABLED = 200  # runs whose table is part of the page; runs.parquet has any number
LABELS = {
    "min_clearance_m": "least clearance [m]",
    "time_to_goal_s": "time to goal, successes [s]",
    "arrival_error_deg": "arrival error, successes [deg]",
    "path_length_m": "path length, successes [m]",
    "localization_rmse_m": "position RMSE [m]",
    "heading_rmse_deg": "heading RMSE [deg]",
    "nees_mean": "NEES / 3",
    "obstacle_speed_rmse_mps": "obstacle speed RMSE [m/s]",
    "lost_fraction": "share of frames lost",
    "time_standing_s": "time standing [s]",
    "max_tilt_deg": "largest tilt [deg]",
    "saccades_per_s": "saccades [1/s]",
    "head_travel_radps": "head travel [rad/s]",
    "real_time_factor": "real-time factor",
}
COLUMNS = {
    "outcome": "",
    "success": "success",
    "falls": "falls",
    "collisions": "contacts",
    "collisions_at_fault": "closing",
    "via_points_passed": "via points",
    "arrival_error_deg": "arrival error [deg]",
    "time_to_goal_s": "time to goal [s]",
    "min_clearance_m": "least clearance [m]",
    "localization_rmse_m": "position RMSE [m]",
    "heading_rmse_deg": "heading RMSE [deg]",
    "nees_mean": "NEES/3",
    "real_time_factor": "real-time factor",
    "exit_reason": "ended by",
}


def write_report(definition: Definition, rows: Sequence[Row], command: str) -> str:
    """The page of one sweep.

    Args:
        definition: of the sweep.
        rows: its results.
        command: command line that makes it.
    """
    summary = summarize(rows)
    lines = [f"# `{definition.name}`: {_seeds(rows)}", "", f"    {command}", ""]
    lines += [f"{definition.made_with()}.", "", *_results(summary), "", *_quantities(summary), ""]
    lines += _worst(definition, rows)
    refused = [row for row in rows if row["outcome"] == REFUSED]
    if refused:
        lines += ["## Not run", ""]
        lines += [f"- {row['seed']}: {_one_line(row.get('error'))}" for row in refused[:WORST]]
        lines += [f"- and {len(refused) - WORST} more"] * (len(refused) > WORST) + [""]
    if 0 < len(rows) <= TABLED:
        lines += ["## Runs", "", *_table(rows), ""]
    return "\n".join(lines)


def write_comparison_of_values(
    key: str, sweeps: Mapping[str, Summary], command: str, made_with: str
) -> str:
    """The page of a sweep over the values of `key`: a line a value.

    Args:
        key: key, or keys, of the scenario.
        sweeps: what each value came to.
        command: command line that makes all of it.
        made_with: versions.
    """
    head = (
        "success",
        "95 %",
        "without fall",
        "falls",
        "contacts per run",
        "per metre",
        "least clearance, median [m]",
        "time to goal, median [s]",
        "position RMSE, median [m]",
    )
    lines = [f"# Over `{key}`", "", f"    {command}", "", f"{made_with}.", ""]
    lines += ["| value | runs | " + " | ".join(head) + " |", "|---" * (len(head) + 2) + "|"]
    for value, summary in sweeps.items():
        medians = [
            _number(summary.quantities[name].median) if name in summary.quantities else ""
            for name in ("min_clearance_m", "time_to_goal_s", "localization_rmse_m")
        ]
        cells = [
            f"`{value}`",
            str(summary.runs),
            f"{summary.success.share:.0%}",
            f"{summary.success.low:.0%} to {summary.success.high:.0%}",
            f"{summary.without_fall.share:.0%}",
            str(summary.falls),
            _number(summary.collisions_per_run),
            _number(summary.collisions_per_metre),
            *medians,
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join([*lines, ""])


def told(share: Share) -> str:
    """A share in words: ``19 of 20, 95.0 % (76.4 to 99.1 %)``."""
    if share.of == 0:
        return "none to count"
    return (
        f"{share.count} of {share.of}, {100 * share.share:.1f} % "
        f"({100 * share.low:.1f} to {100 * share.high:.1f} %)"
    )


def headline(summary: Summary) -> list[tuple[str, str]]:
    """The results that are told first, by label."""
    collisions = summary.collisions
    lines = [
        ("success", told(summary.success)),
        ("criteria met", told(summary.passed)),
        ("without collision", told(summary.without_collision)),
        ("without fall", told(summary.without_fall)),
        (
            "collisions",
            f"{collisions['all']}: {collisions['moving']} with movers, {collisions['static']} with "
            f"standing obstacles; {collisions['closing']} closed by the robot",
        ),
        (
            "collisions per run, per metre",
            f"{_number(summary.collisions_per_run)}, {_number(summary.collisions_per_metre)}",
        ),
        ("falls", str(summary.falls)),
    ]
    if summary.arrived.of:
        lines.append(("successes that arrive within 15 deg", told(summary.arrived)))
    lines.append(("ended by", ", ".join(f"{why} {n}" for why, n in summary.ended.items())))
    for label, count in (
        ("crashed", summary.crashed),
        ("diverged", summary.diverged),
        ("run a second time after a crash", summary.retried),
        ("not run, see below", summary.refused),
    ):
        if count:
            lines.append((label, str(count)))
    return lines


def fault(row: Row) -> str:
    """What is wrong with a run, in a few words; nothing for a good one."""
    if row["outcome"] not in ("passed", "failed"):
        return f"{row['outcome']}: {_one_line(row.get('error'))}"
    said = [
        f"{row[key]} {word if row[key] == 1 else word + 's'}"
        for key, word in (("falls", "fall"), ("collisions", "collision"))
        if row.get(key)
    ]
    if not row.get("success") and not said:
        said.append(str(row.get("exit_reason")))
    if row.get("via_points_missed"):
        said.append(f"{row['via_points_missed']} via points missed")
    if row["outcome"] == "failed" and not said:
        said.append("criteria missed")
    return ", ".join(said)


def _seeds(rows: Sequence[Row]) -> str:
    if not rows:
        return "no runs yet"
    seeds = [row["seed"] for row in rows]
    if len(seeds) == 1:
        return f"seed {seeds[0]}"
    gaps = "" if max(seeds) - min(seeds) == len(seeds) - 1 else ", with gaps"
    return f"{len(seeds)} seeds, {min(seeds)} to {max(seeds)}{gaps}"


def _results(summary: Summary) -> list[str]:
    lines = ["| result | (95 % interval) |", "|---|---|"]
    return lines + [f"| {label} | {text} |" for label, text in headline(summary)]


def _quantities(summary: Summary) -> list[str]:
    lines = ["| per run | n | mean | median | 10 % | 90 % | least | most |", "|---" * 8 + "|"]
    for key, spread in summary.quantities.items():
        values = (spread.mean, spread.median, spread.p10, spread.p90, spread.least, spread.most)
        cells = [LABELS[key], str(spread.n), *map(_number, values)]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def _worst(definition: Definition, rows: Sequence[Row]) -> list[str]:
    bad = [row for row in worst_first(rows) if fault(row)]
    if not bad:
        closest = worst_first(rows)[:3]
        lines = ["## Closest shaves", ""] if closest else []
        shown = closest
    else:
        lines = ["## Worst first", ""]
        shown = bad[:WORST]
    for row in shown:
        clearance = row.get("min_clearance_m")
        near = "" if clearance is None else f"clearance {_number(clearance)} m"
        what = "; ".join(word for word in (fault(row), near) if word)
        lines += [f"- seed {row['seed']}: {what}", f"  `{definition.command(row['seed'])}`"]
    if len(bad) > WORST:
        lines.append(f"- and {len(bad) - WORST} more")
    return [*lines, ""] if lines else []


def _table(rows: Sequence[Row]) -> list[str]:
    lines = ["| seed | " + " | ".join(COLUMNS.values()) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for row in rows:
        cells = [_cell(row.get(key)) for key in COLUMNS]
        lines.append(f"| {row['seed']} | " + " | ".join(cells) + " |")
    return lines


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return _number(value) if isinstance(value, float) else str(value)


def _number(value: float) -> str:
    return f"{value:.3g}"


def _one_line(text: object) -> str:
    lines = str(text or "no message").strip().splitlines()
    return lines[0][:200] if lines else "no message"
