from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.evaluation.sweep.driver import drive, pending
from hsr8.evaluation.sweep.job import Job


class Scripted:
    """An executor whose jobs end at once as the script says."""

    workers = 1

    def __init__(self, script):
        self.script, self.queue, self.submitted = script, [], []

    def submit(self, job):
        self.submitted.append(job)
        self.queue.append(job)

    def wait(self, seconds):
        job = self.queue.pop(0)
        outcome = self.script.get(job.seed, ["passed"])[job.attempt - 1]
        row = {"seed": job.seed, "outcome": outcome, "worker": "w", "attempts": job.attempt}
        return [(job, row | ({"error": "killed"} if outcome == "crashed" else {}))]

    def close(self):
        pass


JOB = Job(0, "/sweep", "", 10.0)


def _drive(seeds, script):
    executor, rows = Scripted(script), []
    drive(
        [replace(JOB, seed=s) for s in seeds],
        executor,
        lambda job, row: rows.append(row),
        lambda: None,
    )
    return executor, {row["seed"]: row for row in rows}


def test_every_job_is_recorded_once():
    executor, rows = _drive(range(5), {})
    assert sorted(rows) == list(range(5))
    assert len(executor.submitted) == 5


def test_a_crashed_run_is_tried_again_elsewhere_once_and_marked():
    executor, rows = _drive([1, 2, 3], {1: ["crashed", "failed"], 2: ["crashed", "crashed"]})
    assert [(j.seed, j.attempt, j.avoid) for j in executor.submitted[3:]] == [
        (1, 2, "w"),
        (2, 2, "w"),
    ]
    assert rows[1] == {
        "seed": 1,
        "outcome": "failed",
        "worker": "w",
        "attempts": 2,
        "first_error": "killed",
    }
    assert rows[2]["outcome"] == "crashed"
    assert "first_error" not in rows[3]


def test_a_run_that_diverges_is_not_tried_again():
    executor, _ = _drive([1], {1: ["diverged"]})
    assert len(executor.submitted) == 1


@given(st.integers(1, 7), st.integers(0, 30))
def test_shards_divide_the_seeds(n, count):
    seeds = tuple(range(100, 100 + count))
    parts = [pending(seeds, [], (i, n)) for i in range(1, n + 1)]
    assert sorted(seed for part in parts for seed in part) == list(seeds)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


@pytest.mark.parametrize(
    ("outcome", "again"),
    [("passed", False), ("failed", False), ("diverged", False), ("crashed", True)],
)
def test_what_has_a_result_is_not_run_again(outcome, again):
    rows = [{"seed": 5, "outcome": outcome}]
    assert pending((4, 5), rows, None) == ((4, 5) if again else (4,))
