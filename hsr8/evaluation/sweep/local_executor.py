"""One process per run on this machine, forked from a server with everything preloaded."""

import multiprocessing
import os
import signal
import sys
import time as clock
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from multiprocessing import forkserver
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess

from hsr8.evaluation.sweep.job import Job, RunResult, StartedJob, lost
from hsr8.parent_watch import ORPHAN, end_with_parent

GRACE = 5.0  # time that interrupted runs get to close their files [s]
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

Entry = Callable[[Sequence[str]], int]


@dataclass(frozen=True, slots=True)
class _Run:
    started: StartedJob
    process: BaseProcess
    deadline: float  # monotonic time [s]


class LocalExecutor:
    """Processes of this machine.

    Args:
        workers: number of runs at a time.
        entry: command line of hsr8, which returns an exit code; called in the child.
        preload: module that the fork server imports before it forks.
    """

    def __init__(self, workers: int, entry: Entry, preload: str) -> None:
        self._workers = workers
        self._entry = entry
        self._waiting: deque[Job] = deque()
        self._running: list[_Run] = []
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
            except (OSError, EOFError) as error:  # no process or no disk space
                ended.append((job, lost(job, f"{type(error).__name__}: {error}")))
        wait([run.process.sentinel for run in self._running], 0.0 if ended else seconds)
        for run in list(self._running):
            timed_out = run.process.exitcode is None and clock.monotonic() > run.deadline
            if timed_out:
                run.process.kill()
                run.process.join()
            if run.process.exitcode is not None:
                self._running.remove(run)
                result = run.started.result(run.process.exitcode, timed_out=timed_out)
                ended.append((run.started.job, result))
        return ended

    def close(self) -> None:
        """Stop the jobs that still run."""
        for run in self._running:
            run.process.terminate()
        end = clock.monotonic() + GRACE
        for run in self._running:
            run.process.join(max(0.0, end - clock.monotonic()))
            run.process.kill()
            run.process.join()
            run.started.messages.unlink(missing_ok=True)
        self._running.clear()

    def _start(self, job: Job) -> _Run:
        """Start the process of a job; the first call waits until the server has loaded."""
        # Ctrl-C interrupts the sweep, which then ends its runs: the server and its children
        # inherit that they ignore it.
        handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            forkserver.ensure_running()
        finally:
            signal.signal(signal.SIGINT, handler)
        started = StartedJob(job)
        arguments = (self._entry, started.arguments, str(started.messages))
        process = self._context.Process(target=_run_in_child, args=arguments)
        process.start()
        return _Run(started, process, clock.monotonic() + job.timeout)


def _run_in_child(entry: Entry, arguments: Sequence[str], messages: str) -> None:
    """Run a command line of hsr8 in a process forked by the server."""
    sweep = multiprocessing.parent_process()
    watched = end_with_parent(os.getppid(), signal.SIGKILL)
    if not watched or sweep is None or not sweep.is_alive():
        os._exit(ORPHAN)
    file = os.open(messages, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    os.dup2(file, 1)
    os.dup2(file, 2)
    sys.exit(entry(arguments))
