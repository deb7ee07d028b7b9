import subprocess
import sys
from dataclasses import replace

import pytest

from hsr8.errors import UsageError
from hsr8.evaluation.sweep import executor as module
from hsr8.evaluation.sweep.executor import LocalExecutor, open_executor, parse_executor
from hsr8.evaluation.sweep.job import Job

JOB = Job(0, "/nowhere", "", 10.0)


@pytest.fixture
def local():
    executor = LocalExecutor(2)
    yield executor
    executor.close()


def _all(executor, n):
    ended = []
    while len(ended) < n:
        ended += executor.wait(5.0)
    return ended


def test_every_job_ends_once(local, monkeypatch):
    monkeypatch.setattr(module, "run_job", lambda job, start: {"seed": job.seed})
    for seed in range(20):
        local.submit(replace(JOB, seed=seed))
    ended = _all(local, 20)
    assert sorted(row["seed"] for _, row in ended) == list(range(20))
    assert all(job.seed == row["seed"] for job, row in ended)
    assert local.wait(0.0) == []


@pytest.mark.parametrize(
    "error",
    [
        OSError("No space left on device"),
        RuntimeError("can't start new thread"),
        OverflowError("timestamp too large"),
    ],
)
def test_a_job_that_cannot_begin_is_a_crash(local, monkeypatch, error):
    def fail(job, start):
        raise error

    monkeypatch.setattr(module, "run_job", fail)
    local.submit(JOB)
    ((_, row),) = _all(local, 1)
    assert row["outcome"] == "crashed"
    assert str(error) in row["error"]


@pytest.mark.parametrize("stubborn", [False, True])
def test_closing_ends_what_runs(monkeypatch, stubborn):
    monkeypatch.setattr(module, "GRACE", 0.3)
    deaf = "signal.signal(signal.SIGTERM, signal.SIG_IGN);" if stubborn else ""
    code = f"import signal, time; {deaf} print(flush=True); time.sleep(60)"
    processes = []

    def run(job, start):
        start([]).communicate()
        return {"seed": job.seed}

    def begin(words):
        process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        process.stdout.readline()
        processes.append(process)
        return process

    monkeypatch.setattr(module, "run_job", run)
    executor = LocalExecutor(1)
    monkeypatch.setattr(executor._launcher, "start", begin)
    executor.submit(JOB)
    executor.submit(JOB)  # waits, and never begins
    while not processes:
        executor.wait(0.01)
    executor.close()
    assert [p.returncode for p in processes] == [-9 if stubborn else -15]


def test_when_the_server_is_killed_its_run_is_a_crash_and_the_next_has_a_new_one(monkeypatch):
    program = "import sys, hsr8.cli.fork_server as p; p.load_everything = lambda: None;"
    program += "p.entry = lambda words: exec(words[0]) or 0; p.main(sys.argv[1:])"
    monkeypatch.setattr(
        "hsr8.evaluation.sweep.fork_server.COMMAND", [sys.executable, "-c", program]
    )

    def run(job, start):
        process = start(
            ["import os, signal; os.kill(os.getppid(), 9); signal.pause()", "pass"][job.seed :]
        )
        process.communicate()
        return {"seed": job.seed, "outcome": "passed"}

    monkeypatch.setattr(module, "run_job", run)
    executor = LocalExecutor(1)
    executor.submit(JOB)
    executor.submit(replace(JOB, seed=1))
    first, second = (row for _, row in _all(executor, 2))
    executor.close()
    assert first["outcome"] == "crashed"
    assert "the process that forks" in first["error"]
    assert second["outcome"] == "passed"


def test_other_names_are_refused():
    for name in ("slurm", "local://here", "", "dask://", "dask://host", "ray://a b:3"):
        with pytest.raises(UsageError, match="local, dask"):
            open_executor(name, 1)


def test_executors_have_addresses():
    assert parse_executor("local") == ("local", "")
    assert parse_executor("dask") == ("dask", "")
    assert parse_executor("dask://node-1.lan:8786") == ("dask", "node-1.lan:8786")
    assert parse_executor("ray://[::1]:10001") == ("ray", "[::1]:10001")


@pytest.mark.parametrize(("name", "package"), [("dask", "distributed"), ("ray", "ray")])
def test_a_missing_extra_says_what_to_install(monkeypatch, name, package):
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(UsageError, match=rf"pip install \"hsr8\[{name}\]\""):
        open_executor(name, 1)
