"""One process per run on this machine, forked from a server with everything preloaded."""

import multiprocessing
import os
import signal
import time as clock
from collections import deque
from multiprocessing import forkserver
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any

from hsr8.evaluation.sweep.child import Child, Work, serve
from hsr8.evaluation.sweep.job import Job, RunResult, run_job, unfinished
from hsr8.parent_watch import ORPHAN, end_with_parent

PRELOAD = "hsr8.evaluation.sweep.preload"
GRACE = 5.0  # time that interrupted runs get to close their files [s]
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class LocalExecutor:
    """Processes of this machine.

    Args:
        workers: number of runs at a time.
        work: called in the process of a run.
        preload: module that the fork server imports before it forks.
    """

    def __init__(self, workers: int, work: Work = run_job, preload: str = PRELOAD) -> None:
        self._workers = workers
        self._work = work
        self._waiting: deque[Job] = deque()
        self._running: list[tuple[Child, BaseProcess]] = []
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload([preload])
        for name in ONE_THREAD:
            os.environ.setdefault(name, "1")
        os.environ["PYTHONSAFEPATH"] = "1"  # the server imports no modules of the current folder

    def submit(self, job: Job) -> None:
        """Add a job."""
        self._waiting.append(job)

    def wait(self, seconds: float) -> list[tuple[Job, RunResult]]:
        """Return the jobs that ended."""
        ended = []
        while self._waiting and len(self._running) < self._workers:
            job = self._waiting.popleft()
            try:
                self._running.append(self._start(job))
            except (OSError, EOFError) as error:  # no process
                ended.append((job, unfinished(job, f"{type(error).__name__}: {error}")))
        sources: list[Any] = [process.sentinel for _, process in self._running]
        sources += [child.results for child, _ in self._running if not child.ended]
        wait(sources, 0.0 if ended else seconds)
        for child, process in list(self._running):
            while child.receive():
                pass
            exit_code = process.exitcode
            if exit_code is None and child.remaining_time > 0.0:
                continue
            if exit_code is None:
                process.kill()
            process.join()
            self._running.remove((child, process))
            ended.append((child.job, child.close(exit_code)))
        return ended

    def close(self) -> None:
        """Stop the jobs that still run."""
        for _, process in self._running:
            process.terminate()
        end = clock.monotonic() + GRACE
        for child, process in self._running:
            process.join(max(0.0, end - clock.monotonic()))
            process.kill()
            process.join()
            child.results.close()
        self._running.clear()

    def _start(self, job: Job) -> tuple[Child, BaseProcess]:
        """Start the process of a job; the first call waits until the server has loaded."""
        # Ctrl-C interrupts the sweep, which then ends its runs; the server inherits that it is
        # ignored.
        handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            forkserver.ensure_running()
        finally:
            signal.signal(signal.SIGINT, handler)
        receiver, sender = self._context.Pipe(duplex=False)
        with sender:
            process = self._context.Process(target=_run, args=(job, sender, self._work))
            process.start()
        return Child(job, receiver), process


def _run(job: Job, results: "Connection[RunResult, object]", work: Work) -> None:
    """Serve a job in a process forked by the server."""
    sweep = multiprocessing.parent_process()
    watched = end_with_parent(os.getppid(), signal.SIGKILL)
    if not watched or sweep is None or not sweep.is_alive():
        os._exit(ORPHAN)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # also under a server that others started
    serve(job, results, work)
