"""Runs on the workers of a Dask cluster; requires the extra ``dask``."""

import pickle
import socket
import subprocess
import sys
from multiprocessing import Pipe
from queue import Empty, SimpleQueue
from tempfile import TemporaryFile
from typing import Any

from hsr8.errors import UsageError
from hsr8.evaluation.sweep import child
from hsr8.evaluation.sweep.definition import code_digest
from hsr8.evaluation.sweep.job import Job, RunResult, unfinished
from hsr8.parent_watch import with_parent_watch

TIMEOUT = 30.0  # for connecting to the scheduler [s]


def work(job: Job) -> RunResult:
    """Run `job` in a new process on the Dask worker that calls this."""
    from distributed import get_worker  # noqa: PLC0415  an extra

    receiver, sender = Pipe(duplex=False)
    with sender, TemporaryFile() as file:
        pickle.dump(job, file)
        file.seek(0)
        words = [sys.executable, "-P", "-m", child.__name__, str(sender.fileno())]
        process = subprocess.Popen(
            with_parent_watch(words), stdin=file, pass_fds=(sender.fileno(),)
        )
    run = child.Child(job, receiver)
    while run.receive(run.remaining_time):
        pass
    try:
        code: int | None = process.wait(run.remaining_time)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        code = None
    return run.close(code) | {"worker": str(get_worker().address)}


class DaskExecutor:
    """Jobs as Dask futures; Dask repeats the jobs of a worker that dies on another worker.

    Args:
        address: ``HOST:PORT`` of the scheduler.

    Raises:
        UsageError: Dask is missing, the scheduler does not answer, or the workers run other code.
    """

    def __init__(self, address: str) -> None:
        option = f"--executor dask://{address}"
        try:
            from distributed import Client  # noqa: PLC0415  an extra
        except ImportError as error:
            raise UsageError(
                f"{option}: package {error.name} is missing; pip install '.[dask]' in the checkout"
            ) from None
        host, _, port = address.rpartition(":")
        try:
            socket.create_connection((host.strip("[]"), int(port)), TIMEOUT).close()
            self._client: Any = Client(f"tcp://{address}", timeout=TIMEOUT, set_as_default=False)
            versions = set(self._client.run(code_digest).values())
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise UsageError(f"{option}: no scheduler at {address}: {reason}") from None
        except ImportError:
            versions = {"none"}
        if versions != {code_digest()}:
            self._client.close()
            raise UsageError(
                f"{option}: no workers, or workers without this version of hsr8; expected the "
                f"same version on every worker"
            )
        self._ended: SimpleQueue[tuple[Job, Any]] = SimpleQueue()
        self._futures: set[Any] = set()

    def submit(self, job: Job) -> None:
        """Add a job."""
        future = self._client.submit(work, job, pure=False)
        self._futures.add(future)
        future.add_done_callback(lambda done: self._ended.put((job, done)))

    def wait(self, seconds: float) -> list[tuple[Job, RunResult]]:
        """Return the jobs that ended."""
        ended = []
        try:
            ended.append(self._ended.get(timeout=seconds))
            while True:
                ended.append(self._ended.get_nowait())
        except Empty:
            return [(job, self._result(job, future)) for job, future in ended]

    def close(self) -> None:
        """Stop the jobs that still run."""
        self._client.cancel(list(self._futures), force=True)
        self._client.close()

    def _result(self, job: Job, future: Any) -> RunResult:
        self._futures.discard(future)
        if future.status == "finished":
            result: RunResult = future.result()
            return result
        error = future.exception() if future.status == "error" else future.status
        return unfinished(job, f"the worker died: {error}")
