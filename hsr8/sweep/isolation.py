"""One process per run, forked from a server with everything preloaded.

A crash or hang of a run ends only this run. Runs end with the process that started them.
"""

import multiprocessing
import os
import pickle
import signal
import socket
import threading
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import forkserver
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess

from hsr8.process.signals import ORPHAN, end_with_parent
from hsr8.sweep.job import Job, RunResult, prune, run_job, unfinished

Work = Callable[[Job], RunResult]

PRELOAD = ["hsr8.sweep.preload"]  # modules that the server imports before it forks
EXIT_TIME = 5.0  # limit for the end of a process after its result [s]
ENVIRONMENT = {  # of the server
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
    "PYTHONSAFEPATH": "1",  # it imports no modules of the current folder
}
_STARTING = threading.Lock()
RUNNING = set[BaseProcess]()
"""Processes of the runs that this process has started."""


def run_isolated(job: Job, work: Work = run_job) -> RunResult:
    """Run a job in a new process, with its wall-clock limit; the worker of every pool calls this.

    Args:
        job: the run.
        work: called in the new process.

    Raises:
        OSError: the process cannot be started.
    """
    context = multiprocessing.get_context("forkserver")
    receiver, sender = context.Pipe(duplex=False)
    with receiver:
        with sender, _STARTING:
            start_server()
            process = context.Process(target=_serve, args=(job, sender, work))
            process.start()  # the first call waits until the server has loaded
            RUNNING.add(process)
        started = clock.monotonic()
        result = {}
        try:
            if receiver.poll(job.timeout):
                result = receiver.recv()
        except (EOFError, OSError, pickle.UnpicklingError):  # the process died
            pass
        process.join(EXIT_TIME if result or clock.monotonic() - started < job.timeout else 0.0)
        code = process.exitcode
        if code is None:
            process.kill()
            process.join()
        RUNNING.discard(process)
    result = {"attempts": job.attempt, **(result or unfinished(job, _ending(job, code)))}
    result |= {"seed": job.seed, "worker": f"{socket.gethostname()}:{process.pid}"}
    return prune(job, result | {"process_s": clock.monotonic() - started})


def start_server() -> None:
    """Start the server that forks the runs, if it does not run.

    Ctrl-C interrupts the sweep, which then ends its runs: a server that the main thread starts
    inherits that the signal is ignored.
    """
    forkserver.set_forkserver_preload(PRELOAD)
    with _ignored_ctrl_c(), _environment():
        # A worker of Dask is a daemon, which may not have children because they could outlive it;
        # these end with their parent.
        multiprocessing.current_process()._config["daemon"] = False  # type: ignore[attr-defined]
        forkserver.ensure_running()


@contextmanager
def _ignored_ctrl_c() -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)


@contextmanager
def _environment() -> Iterator[None]:
    before = {name: os.environ.get(name) for name in ENVIRONMENT}
    os.environ.update({name: before[name] or value for name, value in ENVIRONMENT.items()})
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]


def _ending(job: Job, code: int | None) -> str:
    """Return the end of a process without a result; the exit code is None after the limit."""
    if code is None:
        return f"stopped at the wall-clock limit of {job.timeout:g} s"
    if code < 0:
        return f"killed by {signal.Signals(-code).name}"
    return f"exit code {code} without a result"


def _serve(job: Job, results: "Connection[RunResult, object]", work: Work) -> None:
    """Do a job in a process forked by the server and send its result; print nothing."""
    parent = multiprocessing.parent_process()
    watched = end_with_parent(os.getppid(), signal.SIGKILL)
    if not watched or parent is None or not parent.is_alive():
        os._exit(ORPHAN)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # also under a server that a thread started
    null = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(null, stream)
    results.send(work(job))
    results.close()
