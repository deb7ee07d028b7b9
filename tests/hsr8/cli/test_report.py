"""Result of a run in two lines and in tables."""

import io
from types import SimpleNamespace

import pytest
from rich.console import Console

from hsr8.cli import info, report
from hsr8.recording.verdict import Criterion, reason_of

GOOD = {
    "success": True,
    "exit_reason": "goal",
    "goal_reached": True,
    "time_to_goal_s": 21.4,
    "sim_time_s": 22.4,
    "path_length_m": 3.0,
    "collisions": 0,
    "falls": 0,
    "via_points_passed": 1,
    "via_points_total": 1,
    "min_clearance_m": 0.182,
    "mean_velocity": {"vx": 0.1},
}
HIT = {"success": False, "collisions": 1, "collisions_static": 1, "first_collision_s": 12.3}
GOAL, FALLS = Criterion("goal reached", "yes", "no", False), Criterion("falls", "<= 0", "0", True)


def run_with(tmp_path, **change):
    results = GOOD | change
    return SimpleNamespace(
        manifest={"scenario": "quick"},
        seed=2,
        metrics=results,
        folder=tmp_path / "quick" / "2-7d3de9",
        exit_reason=results["exit_reason"],
    )


def test_a_success_is_two_lines(tmp_path):
    first, second = report.lines(run_with(tmp_path), (FALLS,), tmp_path / "quick")
    assert first == (
        "quick, seed 2: success in 21.4 s   "
        "(0 collisions, 0 falls, 1 of 1 via point, clearance 0.18 m)"
    )
    assert second.startswith(f"{tmp_path}/quick/2-7d3de9   next: hsr8 replay {tmp_path}/quick, ")


@pytest.mark.parametrize(
    ("change", "criteria", "text"),
    [
        (HIT, (FALLS,), "no: 1 collision at 12.3 s, static; the criteria are met"),
        ({"success": True}, (GOAL,), "; criteria missed: goal reached no, expected yes"),
    ],
)
def test_success_and_criteria_that_differ_are_both_stated(tmp_path, change, criteria, text):
    assert text in report.lines(run_with(tmp_path, **change), criteria, tmp_path)[0]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (HIT, "1 collision at 12.3 s, static"),
        (
            {"collisions": 2, "collisions_moving": 2, "first_collision_s": 3.0, "falls": 1},
            "1 fall; 2 collisions, first at 3.0 s, moving",
        ),
        ({"exit_reason": "timeout"}, "timeout at 22.4 s"),
        ({"goal_reached": False}, "the robot stopped away from the goal"),
        ({"via_points_missed": 1}, "1 via point missed"),
    ],
)
def test_a_failure_has_its_reason(change, reason):
    assert reason_of(GOOD | {"success": False} | change) == reason


@pytest.mark.parametrize("everything", [False, True])
def test_the_table_has_units_and_all_results_on_request(tmp_path, everything):
    stream = io.StringIO()
    console = Console(file=stream, width=200)
    info.show(run_with(tmp_path), (GOAL, FALLS), console, everything=everything)
    text = stream.getvalue()
    for words in ("path length [m]", "min clearance [m]", "goal reached", "<= 0"):
        assert words in text
    assert ("mean velocity [m/s, m/s, rad/s]" in text) == everything


def test_a_path_with_spaces_is_quoted(tmp_path):
    assert "hsr8 render '" in report.lines(run_with(tmp_path), (), tmp_path / "my runs")[1]
