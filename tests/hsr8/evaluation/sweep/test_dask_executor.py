"""Needs the extra `dask`; skipped without it."""

import os
import time
from dataclasses import replace

import pytest

pytest.importorskip("distributed")

from hsr8.errors import UsageError
from hsr8.evaluation.sweep import dask_executor as module
from hsr8.evaluation.sweep.dask_executor import DaskExecutor
from hsr8.evaluation.sweep.driver import drive
from hsr8.evaluation.sweep.job import Job

JOB = Job(0, "/nowhere", "", 10.0)


def _work(job):
    """Stands in for a run; the first one of seed 3 takes its worker with it."""
    if job.seed == 3 and job.attempt == 1:
        time.sleep(0.2)
        os._exit(1)
    return {"seed": job.seed, "outcome": "passed", "attempts": job.attempt, "worker": "w"}


def test_every_run_ends_also_that_of_a_worker_that_dies(monkeypatch):
    monkeypatch.setattr(module, "work", _work)
    executor = DaskExecutor("", 2)
    rows = []
    try:
        assert executor.workers == 2
        jobs = [replace(JOB, seed=seed) for seed in range(6)]
        drive(jobs, executor, lambda job, row: rows.append(row), lambda: None)
    finally:
        executor.close()
    found = {row["seed"]: row for row in rows}
    assert sorted(found) == list(range(6))
    assert found[3]["attempts"] == 2
    assert "worker went away" in found[3]["first_error"]


def test_a_scheduler_that_does_not_answer_is_told(monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.5)
    with pytest.raises(UsageError, match="nobody answers"):
        DaskExecutor("127.0.0.1:9", 1)
