"""Table of the results of a run."""

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.evaluation.verdict import Criterion, exit_code
from hsr8.recorder.run import run_folder

SUCCESS = "no collision, no fall, every via point passed, goal (if any) reached"
CRITERIA_MET = "ended by itself and met every bound in [criteria] of the scenario: exit code 0"
VERDICTS = {"success": SUCCESS, "criteria_met": CRITERIA_MET}  # the definitions, for --json
ROWS: tuple[tuple[str, str, str], ...] = (
    ("ended", "exit_reason", "{}"),
    ("success", "success", f"{{}} ({SUCCESS})"),
    ("falls", "falls", "{}"),
    ("collisions", "collisions", "{}"),
    ("  with movers / static", "collisions_moving", "{} / {collisions_static}"),
    ("via points passed", "via_points_passed", "{}"),
    ("time to goal", "time_to_goal_s", "{:.1f} s"),
    ("arrival error", "arrival_error_deg", "{:.1f} deg"),
    ("path length", "path_length_m", "{:.1f} m"),
    ("min clearance", "min_clearance_m", "{:.3f} m"),
    ("localization RMSE", "localization_rmse_m", "{:.3f} m"),
    ("heading RMSE", "heading_rmse_deg", "{:.2f} deg"),
    ("NEES / 3", "nees_mean", "{:.2f}"),
    ("obstacle speed RMSE", "obstacle_speed_rmse_mps", "{:.3f} m/s"),
    ("max tilt", "max_tilt_deg", "{:.1f} deg"),
    ("steps", "steps", "{}"),
    ("mean velocity", "mean_velocity", "{0[vx]:.3f} m/s, {0[vy]:.3f} m/s, {0[wz]:.3f} rad/s"),
    (
        "  minus commanded",
        "velocity_error",
        "{0[commanded][vx]:+.3f} m/s, {0[commanded][vy]:+.3f} m/s, {0[commanded][wz]:+.3f} rad/s",
    ),
    (
        "planned ZMP outside",
        "zmp_outside_sole_ticks",
        "{} of {walk_ticks} ticks; min margin {zmp_min_margin_m:.4f} m",
    ),
    ("limited commands", "limited_fraction", "{0:.1%}{reasons}"),
    (
        "max torque",
        "peak_torque_ratio",
        "{0:.0%} of the limit, {peak_torque_joint}; saturated in {torque_saturated_ticks} ticks",
    ),
    ("max joint speed", "peak_joint_speed_radps", "{0:.1f} rad/s, {peak_speed_joint}"),
    ("joints at their stops", "joint_stop_ticks", "in {} ticks{stopped}"),
    ("walking tick", "walk_tick_mean_ms", "{0:.2f} ms, 99.9 % below {walk_tick_p999_ms:.2f} ms"),
    ("pushes", "pushes", "{}"),
    ("simulated time", "sim_time_s", "{:.1f} s"),
    ("wall time", "wall_time_s", "{:.1f} s, {real_time_factor:.1f}x real time"),
)
HIDDEN_WHEN_ZERO = ("pushes", "joint_stop_ticks")
MAX_REASONS = 3  # of limited commands


def show(
    title: str,
    *,
    results: Mapping[str, Any],
    criteria: Sequence[Criterion],
    path: Path,
    command: str,
    console: Console | None = None,
) -> None:
    """Print results and criteria of a run, and the commands that continue with it."""
    console = console or Console()
    table = Table(title=title, title_justify="left", show_header=False)
    values = {
        **results,
        "reasons": _reasons(results),
        "stopped": _joints(results.get("joint_stop_by")),
    }
    for label, key, form in ROWS:
        value = results.get(key)
        if value is None or (key in HIDDEN_WHEN_ZERO and value == 0):
            continue
        table.add_row(label, form.format(_yes_or_no(value), **values))
    console.print(table)
    if criteria:
        met = _yes_or_no(exit_code(str(results.get("exit_reason")), criteria) == 0)
        console.print(f"criteria_met: {met} ({CRITERIA_MET})", highlight=False, markup=False)
        table = Table("criterion", "expected", "actual", "")
        for criterion in criteria:
            verdict = "[green]met[/]" if criterion.met else "[red]not met[/]"
            table.add_row(criterion.name, criterion.expected, escape(criterion.actual), verdict)
        console.print(table)
    word = shlex.quote(str(path))
    lines = [f"run folder  {path}", f"video       hsr8 render {word}"]
    if (path / run_folder.LOG).exists():
        lines.insert(1, f"log         hsr8 replay {word}")
    if (path / run_folder.WALKING).exists():
        lines.append(f"plots       hsr8 plot {word}")
    lines.append(f"again       {command}")
    for line in lines:
        console.print(line, highlight=False, soft_wrap=True, markup=False)


def _reasons(results: Mapping[str, Any]) -> str:
    """Return the most frequent reasons of limited commands."""
    by = results.get("limited_by") or {}
    most = [f"{name.replace('_', ' ')} {ratio:.1%}" for name, ratio in by.items()][:MAX_REASONS]
    return f" of the ticks: {', '.join(most)}" if most else ""


def _joints(ticks: Mapping[str, int] | None) -> str:
    """Return the joints with their numbers of ticks."""
    return f": {', '.join(f'{name} {n}' for name, n in ticks.items())}" if ticks else ""


def _yes_or_no(value: Any) -> Any:
    return ("no", "yes")[value] if isinstance(value, bool) else value
