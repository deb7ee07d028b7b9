import sys
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.dask_executor import DaskExecutor
from hsr8.evaluation.sweep.job import Job
from hsr8.evaluation.sweep.runs import parse_executor, pending, run_jobs
from hsr8.scenario.loader import load_scenario

JOB = Job(load_scenario("quick"), "/sweep", "", 10.0)


class Scripted:
    """Executor whose jobs end at once with outcomes by seed and attempt."""

    def __init__(self, outcomes):
        self.outcomes, self.queue, self.submitted = outcomes, [], []

    def submit(self, job):
        self.submitted.append(job)
        self.queue.append(job)

    def wait(self, seconds):
        job = self.queue.pop(0)
        outcome = self.outcomes.get(job.seed, ["passed"])[job.attempt - 1]
        result = {"seed": job.seed, "outcome": outcome, "attempts": job.attempt}
        return [(job, result | ({"error": "killed"} if outcome == "crashed" else {}))]


def _run(seeds, outcomes):
    executor, results = Scripted(outcomes), {}
    run_jobs(
        [replace(JOB, scenario=JOB.scenario.with_seed(s)) for s in seeds],
        executor,
        lambda job, result: results.setdefault(job.seed, []).append(result),
        lambda: None,
    )
    assert all(len(each) == 1 for each in results.values())
    return executor, {seed: each[0] for seed, each in results.items()}


def test_every_job_has_one_result():
    executor, results = _run(range(5), {})
    assert sorted(results) == list(range(5))
    assert len(executor.submitted) == 5


def test_a_crashed_run_is_repeated_once():
    executor, results = _run([1, 2, 3], {1: ["crashed", "failed"], 2: ["crashed", "crashed"]})
    assert [(j.seed, j.attempt) for j in executor.submitted[3:]] == [(1, 2), (2, 2)]
    assert results[1] == {"seed": 1, "outcome": "failed", "attempts": 2, "first_error": "killed"}
    assert results[2]["outcome"] == "crashed"
    assert "first_error" not in results[3]


def test_a_diverged_run_is_not_repeated():
    executor, _ = _run([1], {1: ["diverged"]})
    assert len(executor.submitted) == 1


@given(st.integers(1, 7), st.integers(0, 30))
def test_shards_divide_the_seeds(n, count):
    seeds = tuple(range(100, 100 + count))
    parts = [pending(seeds, [], (i, n)) for i in range(1, n + 1)]
    assert sorted(seed for part in parts for seed in part) == list(seeds)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


@pytest.mark.parametrize(
    ("outcome", "pending_again"),
    [("passed", False), ("failed", False), ("diverged", False), ("crashed", True)],
)
def test_seeds_with_a_result_are_not_run_again(outcome, pending_again):
    results = [{"seed": 5, "outcome": outcome}]
    assert pending((4, 5), results, None) == ((4, 5) if pending_again else (4,))


def test_executors_are_local_or_have_an_address():
    assert parse_executor("local") == ""
    assert parse_executor("dask://node-1.lan:8786") == "node-1.lan:8786"
    assert parse_executor("dask://[::1]:8786") == "[::1]:8786"
    for name in ("slurm", "local://here", "", "dask", "dask://", "dask://h:99999", "ray"):
        with pytest.raises(UsageError, match="expected local or dask://HOST:PORT"):
            parse_executor(name)


def test_a_missing_extra_names_the_installation_command(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageError, match=r"pip install '\.\[dask\]'"):
        DaskExecutor("127.0.0.1:9")
