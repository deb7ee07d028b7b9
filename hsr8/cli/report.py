"""Result of a run in two lines."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hsr8.errors import escaped
from hsr8.files.text import shell_word
from hsr8.measure.registry import METRICS
from hsr8.recording.run import Run
from hsr8.recording.verdict import Criterion, counted, exit_code, reason_of

VERDICTS = {  # definitions in JSON output
    "success": METRICS["success"].text,
    "criteria_met": "ended by itself and met all [criteria] of the scenario: exit code 0",
}


def lines(run: Run, criteria: Sequence[Criterion], target: Path) -> list[str]:
    """Return the result of a run, its reason, and the commands that continue with it.

    Args:
        run: run with results.
        criteria: its criteria, evaluated.
        target: the run in the commands, its folder or one above it.
    """
    results = run.metrics
    name = escaped(f"{run.manifest.get('scenario')}, seed {run.seed}")
    word = shell_word(str(target))
    commands = f"hsr8 replay {word}, hsr8 render {word}"
    folder = shell_word(str(run.folder))
    verdict = _verdict(run, criteria)
    return [f"{name}: {verdict}   ({_counts(results)})", f"{folder}   next: {commands}"]


def _verdict(run: Run, criteria: Sequence[Criterion]) -> str:
    """Return whether a run has success, and where its criteria differ from that."""
    results = run.metrics
    if not results["success"]:
        met = exit_code(run.exit_reason, criteria) == 0
        return f"no: {reason_of(results)}" + ("; the criteria are met" if met else "")
    time = results.get("time_to_goal_s") or results["sim_time_s"]
    missed = [f"{c.name} {c.actual}, expected {c.expected}" for c in criteria if not c.met]
    remark = f"; criteria missed: {'; '.join(missed)}" if missed else ""
    return f"success in {time:.1f} s{remark}"


def _counts(results: Mapping[str, Any]) -> str:
    counts = [counted(results[key], key.removesuffix("s")) for key in ("collisions", "falls")]
    total = results["via_points_total"]
    if total:
        passed = results["via_points_passed"]
        # A tour without a goal has more via points than its time allows.
        timed = results["exit_reason"] == "completed"
        points = counted(passed if timed else total, "via point")
        counts.append(points if timed else f"{passed} of {points}")
    if results["min_clearance_m"] is not None:
        counts.append(f"clearance {results['min_clearance_m']:.2f} m")
    return ", ".join(counts)
