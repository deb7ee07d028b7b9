"""Who runs the jobs of a sweep: processes of this machine, or a cluster's workers."""

import re
import time as clock
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from queue import Empty, SimpleQueue
from threading import Lock
from typing import Protocol

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.job import Job, Row, lost, run_job
from hsr8.evaluation.sweep.launcher import Launcher
from hsr8.evaluation.sweep.process import Process

GRACE = 5.0  # an interrupted run has so long to close its files [s]
NAMES = "local, dask, dask://HOST:PORT, ray or ray://HOST:PORT"


class Executor(Protocol):
    """Runs jobs, as many at a time as it has workers."""

    workers: int

    def submit(self, job: Job) -> None:
        """Take a job; it begins when a worker is free."""

    def wait(self, seconds: float) -> list[tuple[Job, Row]]:
        """What has ended since the last call; waits so long for the first of it."""

    def close(self) -> None:
        """Stop what still runs."""


def open_executor(name: str, workers: int) -> Executor:
    """The executor called `name`.

    Args:
        name: see `NAMES`; with an address, a cluster that is there already.
        workers: runs at a time; a cluster with an address has its own number.

    Raises:
        UsageError: there is none of that name, its package is missing, or nobody answers.
    """
    kind, address = parse_executor(name)
    if kind == "dask":
        from hsr8.evaluation.sweep.dask_executor import DaskExecutor  # noqa: PLC0415  an extra

        return DaskExecutor(address, workers)
    if kind == "ray":
        from hsr8.evaluation.sweep.ray_executor import RayExecutor  # noqa: PLC0415  an extra

        return RayExecutor(address, workers)
    return LocalExecutor(workers)


def require_executor(name: str) -> None:
    """Make sure that the packages of the executor called `name` are there; nobody is asked.

    Raises:
        UsageError: there is no executor of that name, or its package is missing.
    """
    kind, _ = parse_executor(name)
    if kind == "dask":
        from hsr8.evaluation.sweep.dask_executor import require_dask  # noqa: PLC0415  an extra

        require_dask()
    if kind == "ray":
        from hsr8.evaluation.sweep.ray_executor import require_ray  # noqa: PLC0415  an extra

        require_ray()


def parse_executor(name: str) -> tuple[str, str]:
    """Kind and address of an executor; the address is empty for one of this machine.

    Raises:
        UsageError: there is none of that name.
    """
    match = re.fullmatch(
        r"(local|dask|ray)|(dask|ray)://([\w.-]+:\d{1,5}|\[[\da-f:]+\]:\d{1,5})", name
    )
    if match is None:
        raise UsageError(f"--executor {name}: choose {NAMES}")
    return match[1] or match[2], match[3] or ""


class LocalExecutor:
    """A process per run on this machine, forked from one that has loaded everything.

    Args:
        workers: runs at a time.
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._pool = ThreadPoolExecutor(workers)
        self._ended: SimpleQueue[tuple[Job, Row]] = SimpleQueue()
        self._running: set[Process] = set()
        self._launcher = Launcher()
        self._lock = Lock()
        self._closed = False

    def submit(self, job: Job) -> None:
        """Take a job."""
        self._pool.submit(self._run, job)

    def wait(self, seconds: float) -> list[tuple[Job, Row]]:
        """What has ended."""
        ended: list[tuple[Job, Row]] = []
        try:
            ended.append(self._ended.get(timeout=seconds))
            while True:
                ended.append(self._ended.get_nowait())
        except Empty:
            return ended

    def close(self) -> None:
        """Interrupt what still runs, and kill what does not end soon."""
        with self._lock:
            self._closed = True
            running = list(self._running)
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in running:
            process.terminate()
        until = clock.monotonic() + GRACE
        while any(process.returncode is None for process in running) and clock.monotonic() < until:
            clock.sleep(0.05)
        for process in running:
            if process.returncode is None:
                process.kill()
        self._pool.shutdown()
        self._launcher.close()

    def _run(self, job: Job) -> None:
        mine: list[Process] = []

        def begin(words: Sequence[str]) -> Process:
            with self._lock:
                process = self._launcher.start(words)
                mine.append(process)
                self._running.add(process)
                if self._closed:
                    process.terminate()
            return process

        try:
            row = run_job(job, begin)
        except Exception as error:  # no process, no disk; without a row the sweep would wait for it
            row = lost(job, f"{type(error).__name__}: {error}")
        finally:
            with self._lock:
                self._running.difference_update(mine)
        self._ended.put((job, row))
