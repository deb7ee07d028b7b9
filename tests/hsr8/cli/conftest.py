"""Sweeps whose runs end at once."""

import pytest

GOOD = {
    "success": True,
    "collisions": 0,
    "falls": 0,
    "path_length_m": 2.0,
    "min_clearance_m": 0.2,
    "exit_reason": "goal",
}


class Instant:
    """Pool whose runs succeed at once, except for the outcomes by seed."""

    def __init__(self, outcomes):
        self.outcomes, self.queue, self.ran = outcomes, [], []
        self.closed = False

    @property
    def free(self):
        return 1 - len(self.queue)

    def submit(self, job):
        self.queue.append(job)
        self.ran.append(job)

    def wait(self, seconds):
        job = self.queue.pop(0)
        outcome = self.outcomes.get(job.seed, "passed")
        if isinstance(outcome, BaseException):
            raise outcome
        if callable(outcome):
            outcome = outcome() or "passed"
        result = {"seed": job.seed, "outcome": outcome, "attempts": job.attempt, "run": job.run}
        return [(job, result | (GOOD if outcome in ("passed", "failed") else {"error": "oh no"}))]

    def close(self):
        self.closed = True


@pytest.fixture
def instant(monkeypatch, tmp_path):
    """Replace the pool; the command runs in `tmp_path`."""
    monkeypatch.chdir(tmp_path)

    def use(outcomes=None):
        executor = Instant(outcomes or {})
        monkeypatch.setattr("hsr8.sweep.runs.open_pool", lambda name, workers: executor)
        return executor

    return use
