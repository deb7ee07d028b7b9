"""Runs on the workers of a Dask cluster; needs the extra ``hsr8[dask]``."""

import logging
from collections import deque
from contextlib import ExitStack
from queue import Empty, SimpleQueue
from typing import Any

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.definition import code_digest
from hsr8.evaluation.sweep.job import Job, Row, lost, run_job
from hsr8.evaluation.sweep.launcher import of_this_process

PATIENCE = 30.0  # a scheduler answers within this time [s]


def work(job: Job) -> Row:
    """Run `job` on the worker that this is called on."""
    from distributed import get_worker  # noqa: PLC0415  an extra

    return run_job(job, of_this_process().start, worker=str(get_worker().address))


def require_dask() -> None:
    """Make sure that the extra is there.

    Raises:
        UsageError: it is not.
    """
    try:
        import dask  # noqa: F401, PLC0415  an extra
        import distributed  # noqa: F401, PLC0415
    except ImportError as error:
        raise UsageError(
            f"--executor dask needs a package that is missing ({error.name}): "
            'pip install "hsr8[dask]", or pip install distributed'
        ) from None


class DaskExecutor:
    """Jobs as Dask futures.

    Args:
        address: ``HOST:PORT`` of a scheduler; empty for a cluster on this machine, reachable
            from this machine only.
        workers: of the cluster on this machine.

    Raises:
        UsageError: the extra is missing, nobody answers, or the cluster runs other code.
    """

    def __init__(self, address: str, workers: int) -> None:
        require_dask()
        import dask  # noqa: PLC0415  an extra
        from distributed import Client, LocalCluster  # noqa: PLC0415

        # A run whose worker died is ours to retry, and to mark.
        dask.config.set({"distributed.scheduler.allowed-failures": 0})
        with ExitStack() as undo:
            self._cluster: Any = None
            if not address:
                self._cluster = LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    host="127.0.0.1",
                    dashboard_address=None,
                    memory_limit=None,
                    silence_logs=logging.CRITICAL,
                )
                undo.callback(self._cluster.close)
            try:
                self._client: Any = Client(
                    self._cluster or f"tcp://{address}",
                    timeout=PATIENCE,
                    set_as_default=False,
                )
                undo.callback(self._client.close)
            except (OSError, ValueError) as error:
                raise UsageError(f"--executor dask://{address}: nobody answers ({error})") from None
            self._ended: SimpleQueue[tuple[Job, Any]] = SimpleQueue()
            self._futures: set[Any] = set()
            self._waiting: deque[Job] = deque()
            self.workers = len(self._check_workers(address))
            undo.pop_all()

    def submit(self, job: Job) -> None:
        """Take a job."""
        self._waiting.append(job)

    def wait(self, seconds: float) -> list[tuple[Job, Row]]:
        """What has ended."""
        self._hand_out()
        ended = []
        try:
            ended.append(self._ended.get(timeout=seconds))
            while True:
                ended.append(self._ended.get_nowait())
        except Empty:
            return [(job, self._row(job, future)) for job, future in ended]

    def close(self) -> None:
        """Take back what has not begun; a cluster on this machine ends with its runs."""
        self._client.cancel(list(self._futures), force=True)
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()

    def _hand_out(self) -> None:
        """Give every free thread of the cluster a job; a retry goes to another worker.

        No job waits on a worker, so that the death of one loses nothing that has not begun.
        """
        workers = self._client.scheduler_info(n_workers=-1)["workers"]
        free = sum(worker["nthreads"] for worker in workers.values()) - len(self._futures)
        for _ in range(min(free, len(self._waiting))):
            job = self._waiting.popleft()
            others = [name for name in workers if name != job.avoid] if job.avoid else []
            elsewhere = {"workers": others, "allow_other_workers": True} if others else {}
            future = self._client.submit(work, job, pure=False, **elsewhere)
            self._futures.add(future)
            future.add_done_callback(lambda done, job=job: self._ended.put((job, done)))

    def _row(self, job: Job, future: Any) -> Row:
        self._futures.discard(future)
        if future.status == "finished":
            row: Row = future.result()
            return row
        error = future.exception() if future.status == "error" else future.status
        return lost(job, f"the worker went away: {error}")

    def _check_workers(self, address: str) -> list[str]:
        """Addresses of the workers; all must run the code that is here."""
        if not address:
            return list(self._client.scheduler_info(n_workers=-1)["workers"])
        try:
            digests: dict[str, str] = self._client.run(code_digest)
        except Exception as error:  # whatever a worker raises comes through
            raise UsageError(
                f"--executor dask://{address}: hsr8 must be installed on every worker ({error})"
            ) from error
        if not digests:
            raise UsageError(f"--executor dask://{address}: the cluster has no worker")
        here = code_digest()
        wrong = [worker for worker, digest in digests.items() if digest != here]
        if wrong:
            raise UsageError(
                f"--executor dask://{address}: {len(wrong)} of {len(digests)} workers run other "
                f"code than here ({wrong[0]}): install the same version there"
            )
        return list(digests)
