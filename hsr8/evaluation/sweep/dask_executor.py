"""Runs on the workers of a Dask cluster; requires the extra ``hsr8[dask]``."""

import signal
import socket
import subprocess
import sys
from queue import Empty, SimpleQueue
from typing import Any

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.definition import code_digest
from hsr8.evaluation.sweep.job import Job, RunResult, StartedJob, lost
from hsr8.parent_watch import with_parent_watch

TIMEOUT = 30.0  # for connecting to the scheduler [s]


def work(job: Job) -> RunResult:
    """Run `job` in a new process on the Dask worker that calls this."""
    from distributed import get_worker  # noqa: PLC0415  an extra

    started = StartedJob(job, str(get_worker().address))
    command = with_parent_watch([sys.executable, "-P", "-m", "hsr8", *started.arguments])
    with started.messages.open("wb") as messages:
        try:
            done = subprocess.run(
                command,
                stdin=subprocess.DEVNULL,
                stdout=messages,
                stderr=messages,
                timeout=job.timeout,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return started.result(-signal.SIGKILL, timed_out=True)
    return started.result(done.returncode)


def require_dask() -> None:
    """Check that Dask is installed.

    Raises:
        UsageError: a package is missing.
    """
    try:
        import distributed  # noqa: F401, PLC0415  an extra
    except ImportError as error:
        raise UsageError(
            f'--executor dask: package {error.name} is missing; pip install "hsr8[dask]"'
        ) from None


class DaskExecutor:
    """Jobs as Dask futures; Dask repeats the jobs of a worker that dies on another worker.

    Args:
        address: ``HOST:PORT`` of the scheduler.

    Raises:
        UsageError: Dask is missing, the scheduler does not answer, or the workers run other code.
    """

    def __init__(self, address: str) -> None:
        require_dask()
        from distributed import Client  # noqa: PLC0415  an extra

        self._name = f"--executor dask://{address}"
        host, _, port = address.rpartition(":")
        try:
            socket.create_connection((host.strip("[]"), int(port)), TIMEOUT).close()
            self._client: Any = Client(f"tcp://{address}", timeout=TIMEOUT, set_as_default=False)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise UsageError(
                f"{self._name}: no scheduler at {address}: {reason[:1].lower()}{reason[1:]}"
            ) from None
        self._ended: SimpleQueue[tuple[Job, Any]] = SimpleQueue()
        self._futures: set[Any] = set()
        try:
            self._check_workers()
        except UsageError:
            self._client.close()
            raise

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
        return lost(job, f"the worker died: {error}")

    def _check_workers(self) -> None:
        """Check that there are workers and that all run the code of this machine."""
        try:
            digests: dict[str, str] = self._client.run(code_digest)
        except Exception as error:  # anything that a worker raises arrives here
            raise UsageError(
                f"{self._name}: hsr8 must be installed on every worker ({error})"
            ) from error
        if not digests:
            raise UsageError(f"{self._name}: the cluster has no worker")
        local = code_digest()
        different = [worker for worker, digest in digests.items() if digest != local]
        if different:
            raise UsageError(
                f"{self._name}: {len(different)} of {len(digests)} workers run other code than "
                f"this machine ({different[0]}); install the same version on every worker"
            )
