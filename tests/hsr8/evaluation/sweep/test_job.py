import json
from dataclasses import replace
from pathlib import Path

import pytest

from hsr8.evaluation.sweep.job import Job, StartedJob, lost

METRICS = {"success": True, "collisions": 0, "state_hash": "ab"}


@pytest.fixture
def job(tmp_path):
    return Job(3, str(tmp_path / "sweep"), "duration = 1.0\n", 30.0)


def _end(job, exit_code, *, folder=True, metrics=True, message="", timed_out=False):
    """Start a job and return its result after a run that left these files."""
    started = StartedJob(job)
    path = Path(job.folder) / "runs" / "quick" / "3-abc"
    if folder:
        path.mkdir(parents=True)
    if folder and metrics:
        (path / "metrics.json").write_text(json.dumps(METRICS))
    started.messages.write_text(message)
    result = started.result(exit_code, timed_out=timed_out)
    assert not started.messages.exists()
    return result


@pytest.mark.parametrize(("code", "outcome"), [(0, "passed"), (1, "failed"), (3, "diverged")])
def test_the_exit_code_is_the_outcome_and_the_metrics_are_the_result(job, code, outcome):
    result = _end(job, code)
    assert result["outcome"] == outcome
    assert result["seed"] == 3
    assert result["run"] == "runs/quick/3-abc"
    assert {key: result[key] for key in METRICS} == METRICS


@pytest.mark.parametrize(
    ("code", "more", "outcome", "word"),
    [
        (-9, {"metrics": False}, "crashed", "killed by SIGKILL"),
        (130, {}, "crashed", "exit code 130"),
        (3, {"metrics": False, "message": "internal error"}, "crashed", "3: internal error"),
        (0, {"folder": False}, "crashed", "exit code 0"),
        (2, {"folder": False, "message": "no world"}, "refused", "no world"),
        (2, {"metrics": False, "message": "planner fails"}, "crashed", "planner fails"),
        (-9, {"timed_out": True}, "crashed", "wall-clock limit of 30 s"),
    ],
)
def test_other_endings_are_errors(job, code, more, outcome, word):
    result = _end(job, code, **more)
    assert result["outcome"] == outcome
    assert word in result["error"]


@pytest.mark.parametrize(
    ("keep", "code", "kept"),
    [("all", 0, True), ("failed", 0, False), ("failed", 1, True), ("none", 1, False)],
)
def test_run_folders_are_kept_as_requested(job, tmp_path, keep, code, kept):
    result = _end(replace(job, keep=keep), code)
    assert (tmp_path / "sweep" / "runs" / "quick" / "3-abc").exists() == kept
    assert (result["run"] is not None) == kept
    assert result["success"] is True


def test_a_folder_with_the_traceback_that_its_result_names_is_always_kept(job, tmp_path):
    started = StartedJob(replace(job, keep="none"))
    file = tmp_path / "sweep" / "runs" / "quick" / "3-abc" / "crash.txt"
    file.parent.mkdir(parents=True)
    file.write_text("Traceback")
    started.messages.write_text(f"internal error\n  traceback: {file}")
    result = started.result(3)
    assert str(file) in result["error"]
    assert file.exists()
    assert result["run"] == "runs/quick/3-abc"


def test_the_folder_of_an_earlier_attempt_is_not_this_run_s(job):
    _end(job, -9)
    assert StartedJob(job).result(0)["run"] is None


def test_the_scenario_travels_with_the_job(job, tmp_path):
    StartedJob(job)
    assert (tmp_path / "sweep" / "scenario.toml").read_text() == job.scenario


def test_a_lost_run_is_a_crash(job):
    assert lost(job, "no space")["outcome"] == "crashed"
    assert lost(job, "no space")["seed"] == 3
