"""Real processes; the work that they do is replaced by the functions of this module."""

import os
import signal
import subprocess
import sys
import time
from multiprocessing import forkserver
from pathlib import Path

import pytest

from hsr8.evaluation.sweep import local_executor as module
from hsr8.evaluation.sweep.job import Job
from hsr8.evaluation.sweep.local_executor import LocalExecutor
from hsr8.scenario.loader import load_scenario

# The children import their work by name, which a test module does not have.
PROGRAM = """
import os, signal, sys, time
from pathlib import Path

def work(job):
    seed, folder = job.seed, Path(job.folder)
    yield {"run": f"runs/{seed}"}
    (folder / f"pid-{seed}").write_text(str(os.getpid()))
    if seed == 1:
        os.kill(os.getpid(), 9)
    if seed == 2:
        signal.pause()
    if seed == 3:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(600)
    if seed == 4:
        os._exit(7)
    ignored = signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    print("printed", file=sys.stderr)
    yield {"outcome": "failed", "ignored": ignored, "threads": os.environ["OMP_NUM_THREADS"]}
    if seed == 6:
        signal.pause()
"""
SCENARIO = load_scenario("quick")


@pytest.fixture(scope="module", autouse=True)
def _server():
    """Stop the fork server at the end: it has not loaded what other tests need."""
    yield
    forkserver._forkserver._stop()


@pytest.fixture
def work(tmp_path, monkeypatch):
    (tmp_path / "work_of_a_test.py").write_text(PROGRAM)
    monkeypatch.syspath_prepend(tmp_path)
    import work_of_a_test  # noqa: PLC0415

    yield work_of_a_test.work
    del sys.modules["work_of_a_test"]


@pytest.fixture
def executor(work, monkeypatch):
    """Two workers; their server has one thread, as in a sweep, so that it ends at once."""
    monkeypatch.setenv("JE_ARROW_MALLOC_CONF", "background_thread:false")
    executor = LocalExecutor(2, work, "hsr8.evaluation.sweep.child")
    yield executor
    executor.close()


def _results(executor, count):
    results = {}
    while len(results) < count:
        results |= {job.seed: result for job, result in executor.wait(0.2)}
    assert executor.wait(0.0) == []
    return results


def job_of(seed, folder, timeout=100.0):
    return Job(SCENARIO.with_seed(seed), str(folder), f"hsr8 run quick --seed {seed}", timeout)


def test_crashing_and_hanging_runs_leave_their_neighbours_alone(executor, tmp_path, capfd):
    for seed in range(1, 9):
        executor.submit(job_of(seed, tmp_path, 3.0 if seed in (2, 3, 6) else 100.0))
    results = _results(executor, 8)
    outcomes = {seed: result["outcome"] for seed, result in results.items()}
    assert outcomes == dict.fromkeys(range(1, 5), "crashed") | dict.fromkeys(range(5, 9), "failed")
    assert results[1]["error"] == "killed by SIGKILL"
    for seed in (2, 3):
        assert results[seed]["error"] == "stopped at the wall-clock limit of 3 s"
    assert results[4]["error"] == "exit code 7 without a result"
    assert "error" not in results[6]  # it has sent its result before it hangs
    assert "printed" not in capfd.readouterr().err


def test_runs_ignore_ctrl_c_and_use_one_thread(executor, tmp_path):
    executor.submit(job_of(9, tmp_path))
    result = _results(executor, 1)[9]
    assert result["ignored"]
    assert result["threads"] == "1"


@pytest.mark.parametrize("seed", [2, 3])
def test_closing_ends_runs_that_ignore_sigterm_too(executor, monkeypatch, tmp_path, seed):
    monkeypatch.setattr(module, "GRACE", 0.3)
    executor.submit(job_of(seed, tmp_path))
    pid = _pid(executor, tmp_path, seed)
    executor.close()
    assert not Path(f"/proc/{pid}").exists()


def test_a_killed_server_is_a_crash_and_the_next_run_has_a_new_one(executor, tmp_path):
    executor.submit(job_of(2, tmp_path))
    pid = _pid(executor, tmp_path, 2)
    server = int(Path(f"/proc/{pid}/stat").read_text().split()[3])
    os.kill(server, signal.SIGKILL)
    assert _results(executor, 1)[2]["outcome"] == "crashed"
    while Path(f"/proc/{server}/stat").read_text().split()[2] != "Z":  # it ends after its run
        time.sleep(0.02)
    executor.submit(job_of(5, tmp_path))
    result = _results(executor, 1)[5]
    assert "error" not in result, result["error"]


def test_runs_and_server_end_with_a_killed_sweep(work, tmp_path):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from work_of_a_test import work\n"
        "from hsr8.evaluation.sweep.job import Job\n"
        "from hsr8.evaluation.sweep.local_executor import LocalExecutor\n"
        "from hsr8.scenario.loader import load_scenario\n"
        "executor, scenario = LocalExecutor(2, work), load_scenario('quick')\n"
        "for seed in (2, 3):\n"
        "    executor.submit(Job(scenario.with_seed(seed), sys.argv[1], '', 100.0))\n"
        "while True: executor.wait(5.0)\n"
    )
    sweep = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)])
    pids = [_pid(None, tmp_path, seed) for seed in (2, 3)]
    sweep.kill()
    sweep.wait()
    end = time.monotonic() + 20.0
    while any(Path(f"/proc/{pid}").exists() for pid in pids):
        assert time.monotonic() < end
        time.sleep(0.02)


def _pid(executor, folder, seed):
    """Wait until the run of `seed` has started; return its process id."""
    file = folder / f"pid-{seed}"
    while not (file.exists() and file.read_text()):
        if executor is None:
            time.sleep(0.02)
        else:
            executor.wait(0.02)
    return int(file.read_text())
