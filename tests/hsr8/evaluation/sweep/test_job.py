import json
import subprocess
import sys
from dataclasses import replace

import pytest

from hsr8.evaluation.sweep import job as module
from hsr8.evaluation.sweep.job import Job, lost

RESULTS = {"success": True, "collisions": 0, "state_hash": "ab"}
# What stands in for a run: a folder, results, an exit code.
SAY = f"""
import sys, pathlib
pathlib.Path(OUT, "quick", "3-abc").mkdir(parents=True)
print({json.dumps(json.dumps(RESULTS))})
sys.exit(CODE)
"""


@pytest.fixture
def job(tmp_path):
    return Job(3, str(tmp_path / "sweep"), "duration = 1.0\n", 30.0)


@pytest.fixture
def run_job():
    """Runs a job whose command line is a line of Python instead."""

    def run(job, code):
        pipe = subprocess.PIPE
        command = [sys.executable, "-c", code]
        return module.run_job(
            job, lambda words: subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True)
        )

    return run


def _say(job, code):
    return SAY.replace("OUT", repr(f"{job.folder}/runs")).replace("CODE", str(code))


@pytest.mark.parametrize(("code", "outcome"), [(0, "passed"), (1, "failed"), (3, "diverged")])
def test_the_exit_code_is_the_outcome_and_the_metrics_are_the_row(job, run_job, code, outcome):
    row = run_job(job, _say(job, code))
    assert row["outcome"] == outcome
    assert row["seed"] == 3
    assert row["run"] == "runs/quick/3-abc"
    assert {key: row[key] for key in RESULTS} == RESULTS


@pytest.mark.parametrize(
    ("code", "outcome", "word"),
    [
        ("import os; os.kill(os.getpid(), 9)", "crashed", "SIGKILL"),
        ("print('{}'); raise SystemExit(130)", "crashed", "exit code 130"),
        ("raise SystemExit(3)", "crashed", "exit code 3"),
        ("print('half a res')", "crashed", "exit code 0"),
        ("import sys; print('no world', file=sys.stderr); sys.exit(2)", "refused", "no world"),
    ],
)
def test_other_ends_are_told(job, run_job, code, outcome, word):
    row = run_job(job, code)
    assert row["outcome"] == outcome
    assert word in row["error"]
    assert row["run"] is None


def test_a_run_that_hangs_is_killed(job, run_job):
    row = run_job(replace(job, timeout=0.3), "import time; time.sleep(60)")
    assert row["outcome"] == "crashed"
    assert "no end after" in row["error"]


@pytest.mark.parametrize(
    ("keep", "code", "kept"),
    [("all", 0, True), ("failed", 0, False), ("failed", 1, True), ("none", 1, False)],
)
def test_run_folders_stay_as_asked(job, run_job, tmp_path, keep, code, kept):
    row = run_job(replace(job, keep=keep), _say(job, code))
    assert (tmp_path / "sweep" / "runs" / "quick" / "3-abc").exists() == kept
    assert (row["run"] is not None) == kept


def test_the_scenario_travels_with_the_job(job, run_job, tmp_path):
    run_job(job, "pass")
    assert (tmp_path / "sweep" / "scenario.toml").read_text() == job.scenario


def test_a_lost_run_is_a_crash(job):
    assert lost(job, "gone")["outcome"] == "crashed"
    assert lost(job, "gone")["seed"] == 3
