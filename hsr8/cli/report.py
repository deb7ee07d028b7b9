"""The result of a run, for people."""

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from hsr8.evaluation.verdict import Criterion
from hsr8.recorder.run import run_folder

ROWS: tuple[tuple[str, str, str], ...] = (
    ("ended", "exit_reason", "{}"),
    ("success", "success", "{}"),
    ("falls", "falls", "{}"),
    ("collisions", "collisions", "{}"),
    ("  with movers / standing", "collisions_moving", "{} / {collisions_static}"),
    ("via points passed", "via_points_passed", "{}"),
    ("time to goal", "time_to_goal_s", "{:.1f} s"),
    ("arrival error", "arrival_error_deg", "{:.1f} deg"),
    ("path length", "path_length_m", "{:.1f} m"),
    ("least clearance", "min_clearance_m", "{:.3f} m"),
    ("localization RMSE", "localization_rmse_m", "{:.3f} m"),
    ("heading RMSE", "heading_rmse_deg", "{:.2f} deg"),
    ("NEES / 3", "nees_mean", "{:.2f}"),
    ("obstacle speed RMSE", "obstacle_speed_rmse_mps", "{:.3f} m/s"),
    ("largest tilt", "max_tilt_deg", "{:.1f} deg"),
    ("steps", "steps", "{}"),
    (
        "mean velocity",
        "mean_velocity",
        "{0[vx]:.3f} m/s forward, {0[vy]:.3f} left, {0[wz]:.3f} rad/s",
    ),
    (
        "  from commanded",
        "velocity_error",
        "{0[commanded][vx]:+.3f} m/s, {0[commanded][vy]:+.3f} m/s, {0[commanded][wz]:+.3f} rad/s",
    ),
    (
        "planned ZMP outside",
        "zmp_outside_sole_ticks",
        "{} of {walk_ticks} ticks; {zmp_min_margin_m:.4f} m inside at least",
    ),
    ("limited commands", "limited_fraction", "{0:.1%}{binding}"),
    (
        "largest torque",
        "peak_torque_ratio",
        "{0:.0%} of the limit, {peak_torque_joint}; at it in {torque_saturated_ticks} ticks",
    ),
    ("fastest joint", "peak_joint_speed_radps", "{0:.1f} rad/s, {peak_speed_joint}"),
    ("setpoints beyond range", "clipped_target_ticks", "in {} ticks{clipped}"),
    ("joints at their stops", "joint_stop_ticks", "in {} ticks{stopped}"),
    ("walking tick", "walk_tick_mean_ms", "{0:.2f} ms, 99.9 % below {walk_tick_p999_ms:.2f} ms"),
    ("pushes", "pushes", "{}"),
    ("simulated time", "sim_time_s", "{:.1f} s"),
    ("wall time", "wall_time_s", "{:.1f} s, {real_time_factor:.1f}x real time"),
)
# What goes without saying.
HIDDEN_WHEN_ZERO = (("pushes", 0), ("clipped_target_ticks", 0), ("joint_stop_ticks", 0))
TOLD_LIMITS = 3  # reasons of altered commands that are told


def show(
    title: str,
    *,
    results: Mapping[str, Any],
    checks: Sequence[Criterion],
    path: Path,
    command: str,
    console: Console | None = None,
) -> None:
    """Print results, criteria, and what can be done with the run."""
    console = console or Console()
    table = Table(title=title, title_justify="left", show_header=False)
    told = {
        **results,
        "binding": _binding(results),
        "clipped": _joints(results.get("clipped_target_by")),
        "stopped": _joints(results.get("joint_stop_by")),
    }
    for label, key, form in ROWS:
        if results.get(key) is not None and (key, results[key]) not in HIDDEN_WHEN_ZERO:
            table.add_row(label, _say(form, results[key], told))
    console.print(table)
    if checks:
        console.print(_criteria(checks))
    word = shlex.quote(str(path))
    lines = [f"run folder  {path}", f"video       hsr8 render {word}"]
    if (path / run_folder.LOG).exists():
        lines.insert(1, f"look at it  hsr8 replay {word}")
    if (path / run_folder.WALKING).exists():
        lines.append(f"plots       hsr8 plot {word}")
    lines.append(f"again       {command}")
    for line in lines:
        console.print(line, highlight=False, soft_wrap=True, markup=False)


def _binding(results: Mapping[str, Any]) -> str:
    """What altered the commands most."""
    by = results.get("limited_by") or {}
    most = [f"{name.replace('_', ' ')} {share:.1%}" for name, share in by.items()][:TOLD_LIMITS]
    return f" of the ticks: {', '.join(most)}" if most else ""


def _joints(ticks: Mapping[str, int] | None) -> str:
    """Which joints, and in how many ticks."""
    return f": {', '.join(f'{name} {n}' for name, n in ticks.items())}" if ticks else ""


def _criteria(checks: Sequence[Criterion]) -> Table:
    table = Table("criterion", "expected", "actual", "")
    for check in checks:
        verdict = "[green]met[/]" if check.met else "[red]not met[/]"
        table.add_row(check.name, check.expected, escape(check.actual), verdict)
    return table


def _say(form: str, value: Any, results: Mapping[str, Any]) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return form.format(value, **results)
