"""Pools of real processes; the work that they do is replaced by the functions of this module."""

import os
import signal
import subprocess
import sys
import time
from multiprocessing import forkserver
from pathlib import Path

import pytest

from hsr8.errors import Hsr8Error, UsageError
from hsr8.scenario.loader import load_scenario
from hsr8.sweep import isolation, pools
from hsr8.sweep.job import Job
from hsr8.sweep.pools import DaskPool, LocalPool, parse_executor

# The processes of runs import their work by name, which a test module does not have.
PROGRAM = """
import os, signal, sys, time
from pathlib import Path

def work(job):
    seed, folder = job.seed, Path(job.folder)
    if seed == 8:
        from mujoco import egl
        from walking.walk import plan_tick
        threads = len(os.listdir(f"/proc/{os.getppid()}/task"))
        loaded = (len(plan_tick.signatures), egl.EGL_DISPLAY, "rerun" in sys.modules)
        (folder / "server").write_text(repr((threads, *loaded)))
    (folder / f"pid-{seed}").write_text(str(os.getpid()))
    if seed == 1:
        os.kill(os.getpid(), 9)
    if seed in (2, 8):
        signal.pause()
    if seed == 3:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(600)
    if seed == 4:
        os._exit(7)
    ignored = signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    print("printed", file=sys.stderr)
    return {"outcome": "failed", "ignored": ignored, "threads": os.environ["OMP_NUM_THREADS"]}
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
def pool(work, monkeypatch):
    """Two workers; their server has one thread, as in a sweep, so that it ends at once."""
    monkeypatch.setenv("JE_ARROW_MALLOC_CONF", "background_thread:false")
    monkeypatch.setattr(isolation, "PRELOAD", ["hsr8.sweep.job"])
    pool = LocalPool(2, work)
    yield pool
    pool.close()


def results_of(pool, jobs):
    """Return the results of jobs by seed."""
    jobs, results = [*jobs], {}
    n = len(jobs)
    while len(results) < n:
        while jobs and pool.free > 0:
            pool.submit(jobs.pop(0))
        results |= {job.seed: result for job, result in pool.wait(0.2)}
    assert pool.wait(0.0) == []
    return results


def job_of(seed, folder, timeout=100.0):
    return Job(SCENARIO.with_seed(seed), str(folder), f"runs/quick/{seed}-1", "", timeout)


def test_crashing_and_hanging_runs_leave_their_neighbours_alone(pool, tmp_path, capfd):
    limits = {2: 1.0, 3: 1.0}
    results = results_of(pool, (job_of(s, tmp_path, limits.get(s, 100.0)) for s in range(1, 8)))
    outcomes = {seed: result["outcome"] for seed, result in results.items()}
    assert outcomes == dict.fromkeys(range(1, 5), "crashed") | dict.fromkeys(range(5, 8), "failed")
    assert results[1]["error"] == "killed by SIGKILL"
    for seed in limits:
        assert results[seed]["error"] == "stopped at the wall-clock limit of 1 s"
    assert results[4]["error"] == "exit code 7 without a result"
    assert results[5]["ignored"]
    assert results[5]["threads"] == "1"
    workers = {int(result["worker"].rpartition(":")[2]) for result in results.values()}
    assert len(workers) == 7
    assert os.getpid() not in workers
    assert "printed" not in capfd.readouterr().err


def test_the_environment_is_as_before(pool, tmp_path):
    results_of(pool, [job_of(5, tmp_path)])
    assert "PYTHONSAFEPATH" not in os.environ


@pytest.mark.parametrize("seed", [2, 3])
def test_closing_ends_runs_that_ignore_sigterm_too(pool, monkeypatch, tmp_path, seed):
    monkeypatch.setattr(pools, "GRACE", 0.3)
    pool.submit(job_of(seed, tmp_path))
    pid = pid_of(tmp_path, seed)
    pool.close()
    assert not Path(f"/proc/{pid}").exists()


def test_closing_ends_a_run_that_is_starting(pool, tmp_path):
    pool.submit(job_of(2, tmp_path))
    pool.close()
    assert not isolation.RUNNING


def test_a_killed_server_is_a_crash_and_the_next_run_has_a_new_one(pool, tmp_path):
    pool.submit(job_of(2, tmp_path))
    pid = pid_of(tmp_path, 2)
    server = int(Path(f"/proc/{pid}/stat").read_text().split()[3])
    os.kill(server, signal.SIGKILL)
    ((_, result),) = pool.wait(60.0)
    assert result["outcome"] == "crashed"
    assert "error" not in results_of(pool, [job_of(5, tmp_path)])[5]


def test_runs_and_server_end_with_a_killed_sweep(work, tmp_path):
    """The server has one thread and the compiled code, but neither a display nor Rerun."""
    code = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from work_of_a_test import work\n"
        "from hsr8.sweep.job import Job\n"
        "from hsr8.sweep.pools import LocalPool\n"
        "from hsr8.scenario.loader import load_scenario\n"
        "pool, scenario = LocalPool(2, work), load_scenario('quick')\n"
        "for seed in (8, 3):\n"
        "    pool.submit(Job(scenario.with_seed(seed), sys.argv[1], 'runs', '', 100.0))\n"
        "while True: pool.wait(5.0)\n"
    )
    sweep = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)])
    pids = [pid_of(tmp_path, seed) for seed in (8, 3)]
    assert (tmp_path / "server").read_text() == "(1, 1, None, False)"
    sweep.kill()
    sweep.wait()
    end = time.monotonic() + 20.0
    while any(Path(f"/proc/{pid}").exists() for pid in pids):
        assert time.monotonic() < end
        time.sleep(0.02)


def pid_of(folder, seed):
    """Wait until the run of `seed` has started; return its process id."""
    file = folder / f"pid-{seed}"
    while not (file.exists() and file.read_text()):
        time.sleep(0.02)
    return int(file.read_text())


@pytest.fixture
def cluster():
    """Cluster on this machine, with the extra `dask`."""
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "host": "127.0.0.1"}
    with distributed.LocalCluster(**options, dashboard_address=None) as cluster:
        yield cluster


def address_of(cluster):
    return cluster.scheduler_address.removeprefix("tcp://")


def test_every_run_of_a_cluster_ends_even_if_a_worker_is_killed(cluster, tmp_path):
    settings = ("robot.body=kinematic", "camera.source=analytic", "duration=0.3")
    scenario = load_scenario("walk", settings)
    pool = DaskPool(address_of(cluster))
    limits = {2: 0.01}
    jobs = [
        Job(scenario.with_seed(s), str(tmp_path), f"runs/walk/{s}-1", "", limits.get(s, 100.0))
        for s in range(6)
    ]
    for job in jobs[:4]:
        pool.submit(job)
    ended = pool.wait(100.0)
    os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)
    results = {job.seed: result for job, result in ended} | {}
    while len(results) < 4:
        results |= {job.seed: result for job, result in pool.wait(5.0)}
    results |= results_of(pool, jobs[4:])
    pool.close()
    assert "wall-clock limit" in results.pop(2)["error"]
    assert {result["outcome"] for result in results.values()} == {"passed"}
    assert all((tmp_path / result["run"] / "metrics.json").exists() for result in results.values())


def test_a_lost_scheduler_is_one_error_without_results(cluster, tmp_path):
    pool = DaskPool(address_of(cluster))
    pool.submit(job_of(2, tmp_path))
    cluster.close()
    with pytest.raises(Hsr8Error, match="the connection to the scheduler was lost"):
        pool.wait(60.0)
    pool.close()


def test_a_scheduler_that_does_not_answer_is_reported():
    pytest.importorskip("distributed")
    with pytest.raises(UsageError, match=r"no scheduler at 127\.0\.0\.1:9: connection refused"):
        DaskPool("127.0.0.1:9")


def test_executors_are_local_or_have_an_address():
    assert parse_executor("local") == ""
    assert parse_executor("dask://node-1.lan:8786") == "node-1.lan:8786"
    assert parse_executor("dask://[::1]:8786") == "[::1]:8786"
    for name in ("slurm", "local://here", "", "dask", "dask://", "dask://h:99999", "ray"):
        with pytest.raises(UsageError, match="expected local or dask://HOST:PORT"):
            parse_executor(name)
