"""Pools of workers that run jobs: processes of this machine, and workers of a Dask cluster."""

import os
import re
import socket
import time as clock
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.process import BaseProcess
from queue import Empty, SimpleQueue
from typing import Any, Protocol

from hsr8.errors import Hsr8Error, UsageError
from hsr8.recording.manifest import code_digest
from hsr8.sweep.isolation import RUNNING, Work, run_isolated, start_server
from hsr8.sweep.job import Job, RunResult, run_job, unfinished

GRACE = 5.0  # time that interrupted runs get to close their files [s]
TIMEOUT = 30.0  # for connecting to the scheduler [s]
QUEUED = 2  # jobs per thread of a cluster, so that no thread waits for the next one


class Pool(Protocol):
    """Runs jobs, as many at a time as it has workers."""

    @property
    def free(self) -> int:
        """Number of jobs that it can take now."""

    def submit(self, job: Job) -> None:
        """Run a job."""

    def wait(self, seconds: float) -> list[tuple[Job, RunResult]]:
        """Return the jobs that ended; wait up to `seconds` for the first."""

    def close(self) -> None:
        """Stop the jobs that still run."""


class _Futures:
    """Jobs as futures, of threads or of Dask.

    Args:
        submit: starts a call and returns its future.
        work: called in the process of a run.
    """

    def __init__(self, submit: Callable[..., Any], work: Work) -> None:
        self._submit, self._work = submit, work
        self._ended: SimpleQueue[tuple[Job, Any]] = SimpleQueue()
        self._futures: set[Any] = set()

    def submit(self, job: Job) -> None:
        """Run a job."""
        future = self._submit(run_isolated, job, self._work)
        self._futures.add(future)
        future.add_done_callback(lambda done: self._ended.put((job, done)))

    def wait(self, seconds: float) -> list[tuple[Job, RunResult]]:
        """Return the jobs that ended; wait up to `seconds` for the first."""
        ended = []
        try:
            ended.append(self._ended.get(timeout=seconds))
            while True:
                ended.append(self._ended.get_nowait())
        except Empty:
            return [(job, self._result(job, future)) for job, future in ended]

    def _result(self, job: Job, future: Any) -> RunResult:
        self._futures.discard(future)
        error = future.exception()
        if error is not None:
            return unfinished(job, f"{type(error).__name__}: {error}")
        result: RunResult = future.result()
        return result


class LocalPool(_Futures):
    """Processes of this machine, each guarded by a thread.

    Args:
        workers: number of runs at a time.
        work: called in the process of a run.
    """

    def __init__(self, workers: int, work: Work = run_job) -> None:
        self._threads, self._workers = ThreadPoolExecutor(workers), workers
        super().__init__(self._threads.submit, work)
        start_server()

    @property
    def free(self) -> int:
        """Number of jobs that it can take now."""
        return self._workers - len(self._futures)

    def close(self) -> None:
        """Stop the jobs that still run."""
        self._threads.shutdown(wait=False, cancel_futures=True)
        end, stopped = clock.monotonic() + GRACE, set[BaseProcess]()
        while not all(future.done() for future in self._futures):
            for process in list(RUNNING):  # also one that has just started
                if clock.monotonic() > end:
                    process.kill()
                elif process not in stopped:
                    process.terminate()
                    stopped.add(process)
            clock.sleep(0.02)


class DaskPool(_Futures):
    """Workers of a Dask cluster; Dask repeats the jobs of a worker that dies on another worker.

    Args:
        address: ``HOST:PORT`` of the scheduler.
        work: called in the process of a run.

    Raises:
        UsageError: Dask is missing, the scheduler does not answer, or the workers run other code.
    """

    def __init__(self, address: str, work: Work = run_job) -> None:
        self._option = f"--executor dask://{address}"
        try:
            from distributed import Client  # noqa: PLC0415  an extra
        except ImportError as error:
            raise UsageError(
                f"{self._option}: package {error.name} is missing; pip install -e '.[dask]' in the "
                "checkout"
            ) from None
        host, _, port = address.rpartition(":")
        try:
            socket.create_connection((host.strip("[]"), int(port)), TIMEOUT).close()
            self._client: Any = Client(f"tcp://{address}", timeout=TIMEOUT, set_as_default=False)
            versions = set(self._client.run(code_digest).values())
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise UsageError(f"{self._option}: no scheduler at {address}: {reason}") from None
        except ImportError:
            versions = {"none"}
        if versions != {code_digest()}:
            self._client.close()
            raise UsageError(
                f"{self._option}: no workers, or workers without this version of hsr8; expected "
                "the same version on every worker"
            )
        super().__init__(lambda *call: self._client.submit(*call, pure=False), work)

    @property
    def free(self) -> int:
        """Number of jobs that it can take now.

        Raises:
            Hsr8Error: the scheduler was lost.
        """
        if self._client.status != "running":
            raise self._lost()
        threads: int = sum(self._client.nthreads().values())
        return QUEUED * threads - len(self._futures)

    def close(self) -> None:
        """Stop the jobs that still run."""
        if self._client.status == "running":
            self._client.cancel(list(self._futures), force=True)
        self._client.close()

    def _result(self, job: Job, future: Any) -> RunResult:
        if future.status in ("cancelled", "lost"):
            raise self._lost()
        return super()._result(job, future)

    def _lost(self) -> Hsr8Error:
        return Hsr8Error(f"{self._option}: the connection to the scheduler was lost")


def parse_executor(name: str) -> str:
    """Return the ``HOST:PORT`` of a Dask scheduler, empty for this machine.

    Raises:
        UsageError: `name` is neither "local" nor "dask://HOST:PORT".
    """
    match = re.fullmatch(r"local|dask://((?:[\w.-]+|\[[\da-f:]+\]):(\d{1,5}))", name)
    if match is None or int(match[2] or 0) > 65535:
        raise UsageError(
            f"--executor: unknown executor, got {name}; expected local or dask://HOST:PORT"
        )
    return match[1] or ""


def open_pool(name: str, workers: int | None) -> Pool:
    """Return the pool called `name`.

    Args:
        name: "local" or "dask://HOST:PORT".
        workers: parallel runs on this machine; None for the number of CPUs.
    """
    address = parse_executor(name)
    if address:
        return DaskPool(address)
    return LocalPool(workers or len(os.sched_getaffinity(0)))
