"""Requires the extra `dask`; skipped without it."""

import os
import time

import pytest

from hsr8.errors import UsageError
from hsr8.evaluation.sweep import dask_executor as module
from hsr8.evaluation.sweep.dask_executor import DaskExecutor
from hsr8.evaluation.sweep.job import Job
from hsr8.evaluation.sweep.runs import run_jobs
from hsr8.scenario.loader import load_scenario

distributed = pytest.importorskip("distributed")


@pytest.fixture
def address():
    """Address of the scheduler of a cluster on this machine."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as cluster:
        yield cluster.scheduler_address.removeprefix("tcp://")


def test_every_run_ends_even_if_its_worker_dies(address, monkeypatch, tmp_path):
    def work(job):
        if job.seed == 3 and not (tmp_path / "died").exists():
            (tmp_path / "died").touch()
            time.sleep(0.2)
            os._exit(1)
        return {"seed": job.seed, "outcome": "passed", "attempts": job.attempt}

    monkeypatch.setattr(module, "work", work)
    executor = DaskExecutor(address)
    seeds = []
    scenario = load_scenario("quick")
    jobs = [Job(scenario.with_seed(seed), "/nowhere", "", 10.0) for seed in range(6)]
    run_jobs(jobs, executor, lambda job, result: seeds.append(result["seed"]), lambda: None)
    executor.close()
    assert sorted(seeds) == list(range(6))


def test_a_run_has_a_process_and_a_wall_clock_limit(address, tmp_path):
    executor = DaskExecutor(address)
    settings = ("robot.body=kinematic", "camera.source=analytic", "duration=0.3")
    scenario = load_scenario("walk", settings)
    executor.submit(Job(scenario.with_seed(1), str(tmp_path), "hsr8 run", 100.0))
    executor.submit(Job(scenario.with_seed(2), str(tmp_path), "hsr8 run", 0.01))
    results = {}
    while len(results) < 2:
        results |= {job.seed: result for job, result in executor.wait(5.0)}
    executor.close()
    assert results[1]["outcome"] == "passed"
    assert (tmp_path / results[1]["run"] / "metrics.json").exists()
    assert results[2]["outcome"] == "crashed"
    assert "wall-clock limit" in results[2]["error"]


def test_a_scheduler_that_does_not_answer_is_reported():
    with pytest.raises(UsageError, match=r"no scheduler at 127\.0\.0\.1:9: connection refused"):
        DaskExecutor("127.0.0.1:9")
