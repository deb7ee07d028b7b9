"""Results of a run: two lines after the run, and a table."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console

from hsr8.cli import tables
from hsr8.errors import escaped
from hsr8.evaluation.registry import METRICS, Shown, shown_in
from hsr8.files.shell import shell_word
from hsr8.recorder.run.run import Run
from hsr8.recorder.run.verdict import Criterion, counted, exit_code, reason_of

VERDICTS = {  # definitions
    "success": METRICS["success"].text,
    "criteria_met": "ended by itself and met all [criteria] of the scenario: exit code 0",
}
PLAIN = (  # first rows of the table
    *("success", "exit_reason", "time_to_goal_s", "path_length_m", "collisions", "falls"),
    *("via_points_passed", "min_clearance_m"),
)


def lines(run: Run, criteria: Sequence[Criterion], target: Path) -> list[str]:
    """Return the result of a run, its reason, and the commands that continue with it.

    Args:
        run: run with results.
        criteria: its criteria, evaluated.
        target: the run in the commands, its folder or one above it.
    """
    results = run.metrics
    verdict = f"no: {reason_of(results)}"
    if results["success"]:
        time = results.get("time_to_goal_s") or results["sim_time_s"]
        verdict = f"success in {time:.1f} s"
    missed = [f"{c.name} {c.actual}, expected {c.expected}" for c in criteria if not c.met]
    if results["success"] and missed:
        verdict += f"; criteria missed: {'; '.join(missed)}"
    elif not results["success"] and exit_code(run.exit_reason, criteria) == 0:
        verdict += "; the criteria are met"
    name = escaped(f"{run.manifest.get('scenario')}, seed {run.seed}")
    word = shell_word(str(target))
    commands = f"hsr8 replay {word}, hsr8 render {word}"
    folder = shell_word(str(run.folder))
    return [f"{name}: {verdict}   ({_counts(results)})", f"{folder}   next: {commands}"]


def _head(name: str) -> str:
    """Return the name of a metric, with the unit that it does not state itself."""
    unit = METRICS[name].unit
    return f"{name} [{unit}]" if "," in unit else name


def _counts(results: Mapping[str, Any]) -> str:
    counts = [counted(results[key], key.removesuffix("s")) for key in ("collisions", "falls")]
    total = results["via_points_total"]
    if total:
        counts.append(f"{results['via_points_passed']} of {counted(total, 'via point')}")
    if results["min_clearance_m"] is not None:
        counts.append(f"clearance {results['min_clearance_m']:.2f} m")
    return ", ".join(counts)


def show(run: Run, criteria: Sequence[Criterion], console: Console, *, everything: bool) -> None:
    """Print the results and criteria of a run as tables.

    Args:
        run: run with results.
        criteria: its criteria, evaluated.
        console: output.
        everything: all results, not the first rows only.
    """
    names = [*PLAIN]
    if everything:
        names += [m.name for m in shown_in(Shown.RUN) if m.name not in PLAIN]
    values = {_head(name): run.metrics.get(name) for name in names}
    console.print(tables.facts(values, "results"))
    if criteria:
        console.print(tables.rows([asdict(criterion) for criterion in criteria]))
