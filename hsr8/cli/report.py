"""Table of the results of a run."""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console

from hsr8.cli import tables
from hsr8.evaluation.verdict import Criterion, exit_code
from hsr8.recorder.run import run_folder

VERDICTS = {  # definitions
    "success": "no collision, no fall, every via point passed, goal (if any) reached",
    "criteria_met": "ended by itself and met all [criteria] of the scenario: exit code 0",
}
SHOWN = """
    exit_reason falls collisions collisions_moving collisions_static via_points_passed
    time_to_goal_s arrival_error_deg path_length_m min_clearance_m
    localization_rmse_m heading_rmse_deg nees_mean obstacle_speed_rmse_mps
    max_tilt_deg steps pushes mean_velocity velocity_error limited_fraction limited_by
    zmp_outside_sole_ticks zmp_min_margin_m peak_torque_ratio peak_torque_joint
    torque_saturated_ticks peak_joint_speed_radps peak_speed_joint
    joint_stop_ticks joint_stop_by
    walk_tick_mean_ms walk_tick_p999_ms sim_time_s wall_time_s real_time_factor
""".split()  # noqa: SIM905


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
    console.print(tables.facts({key: results.get(key) for key in SHOWN}, title))
    if results:
        met = exit_code(str(results.get("exit_reason")), criteria) == 0
        verdicts = {"success": results.get("success"), "criteria_met": met}
        for name, verdict in verdicts.items():
            text = f"{name:<14}{'yes' if verdict else 'no'} ({VERDICTS[name]})"
            console.print(text, highlight=False, soft_wrap=True, markup=False)
    if criteria:
        console.print(tables.rows([asdict(criterion) for criterion in criteria]))
    word = shlex.quote(str(path))
    lines = [f"run folder  {path}", f"video       hsr8 render {word}"]
    if (path / run_folder.LOG).exists():
        lines.insert(1, f"log         hsr8 replay {word}")
    lines += [f"plots       hsr8 plot {word}", f"again       {command}"]
    for line in lines:
        console.print(line, highlight=False, soft_wrap=True, markup=False)
