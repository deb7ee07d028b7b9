"""Real processes; their command line is replaced by the functions of this module."""

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

# The children import their entry by name, which a test module does not have.
PROGRAM = """
import os, signal, sys, time
from pathlib import Path

def entry(arguments):
    seed = int(arguments[arguments.index("--seed") + 1])
    folder = Path(arguments[arguments.index("--out") + 1])
    (folder / f"pid-{seed}").write_text(str(os.getpid()))
    if seed == 1:
        os.kill(os.getpid(), 9)
    if seed == 2:
        signal.pause()
    if seed == 3:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(600)
    print(signal.getsignal(signal.SIGINT) == signal.SIG_IGN, os.environ["OMP_NUM_THREADS"])
    print("oh" * 100_000, "end", file=sys.stderr)
    return 7
"""


@pytest.fixture(scope="module", autouse=True)
def _server():
    """Stop the fork server at the end: it has not loaded what other tests need."""
    yield
    forkserver._forkserver._stop()


@pytest.fixture
def entry(tmp_path, monkeypatch):
    (tmp_path / "entry_of_a_test.py").write_text(PROGRAM)
    monkeypatch.syspath_prepend(tmp_path)
    import entry_of_a_test  # noqa: PLC0415

    yield entry_of_a_test.entry
    del sys.modules["entry_of_a_test"]


@pytest.fixture
def executor(entry):
    executor = LocalExecutor(2, entry, "json")
    yield executor
    executor.close()


def _results(executor, count):
    results = {}
    while len(results) < count:
        results |= {job.seed: result for job, result in executor.wait(0.2)}
    assert executor.wait(0.0) == []
    return results


def test_crashing_and_hanging_runs_leave_their_neighbours_alone(executor, tmp_path):
    for seed in range(1, 8):
        executor.submit(Job(seed, str(tmp_path), "", 0.5 if seed in (2, 3) else 100.0))
    results = _results(executor, 7)
    assert {seed: result["outcome"] for seed, result in results.items()} == dict.fromkeys(
        range(1, 8), "crashed"
    )
    assert "SIGKILL" in results[1]["error"]
    assert "wall-clock limit" in results[2]["error"]
    assert "wall-clock limit" in results[3]["error"]
    for seed in range(4, 8):
        assert results[seed]["error"].startswith("exit code 7: ohoh")
        assert results[seed]["error"].endswith("end")
    assert not list(tmp_path.glob("runs/*.messages"))


def test_runs_ignore_ctrl_c_and_use_one_thread(executor, tmp_path, monkeypatch):
    monkeypatch.setattr("hsr8.evaluation.sweep.job.MAX_ERROR", 1_000_000)
    executor.submit(Job(9, str(tmp_path), "", 100.0))
    assert "True 1\n" in _results(executor, 1)[9]["error"]


@pytest.mark.parametrize("seed", [2, 3])
def test_closing_ends_runs_that_ignore_sigterm_too(executor, monkeypatch, tmp_path, seed):
    monkeypatch.setattr(module, "GRACE", 0.3)
    executor.submit(Job(seed, str(tmp_path), "", 100.0))
    pid = _pid(executor, tmp_path, seed)
    executor.close()
    assert not Path(f"/proc/{pid}").exists()


def test_a_killed_server_is_a_crash_and_the_next_run_has_a_new_one(executor, tmp_path):
    executor.submit(Job(2, str(tmp_path), "", 100.0))
    pid = _pid(executor, tmp_path, 2)
    server = int(Path(f"/proc/{pid}/stat").read_text().split()[3])
    os.kill(server, signal.SIGKILL)
    assert _results(executor, 1)[2]["outcome"] == "crashed"
    while Path(f"/proc/{server}/stat").read_text().split()[2] != "Z":  # it ends after its run
        time.sleep(0.02)
    executor.submit(Job(4, str(tmp_path), "", 100.0))
    assert "exit code 7" in _results(executor, 1)[4]["error"]


def test_a_full_disk_is_a_crash_of_the_run(executor, tmp_path):
    (tmp_path / "file").touch()
    executor.submit(Job(4, str(tmp_path / "file"), "", 100.0))
    assert "NotADirectoryError" in _results(executor, 1)[4]["error"]


def test_runs_and_server_end_with_a_killed_sweep(entry, tmp_path):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from entry_of_a_test import entry\n"
        "from hsr8.evaluation.sweep.job import Job\n"
        "from hsr8.evaluation.sweep.local_executor import LocalExecutor\n"
        "executor = LocalExecutor(2, entry, 'hsr8.cli.sweep_preload')\n"
        "[executor.submit(Job(seed, sys.argv[1], '', 100.0)) for seed in (2, 3)]\n"
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
    file = folder / "runs" / f"pid-{seed}"
    while not (file.exists() and file.read_text()):
        if executor is None:
            time.sleep(0.02)
        else:
            executor.wait(0.02)
    return int(file.read_text())
