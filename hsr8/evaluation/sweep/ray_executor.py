"""Runs as Ray tasks; needs the extra ``hsr8[ray]``."""

import os
from typing import Any

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.definition import code_digest
from hsr8.evaluation.sweep.job import Job, Row, lost, run_job
from hsr8.evaluation.sweep.launcher import of_this_process


def work(job: Job) -> Row:
    """Run `job` on the worker that this is called on."""
    return run_job(job, of_this_process().start)


def require_ray() -> None:
    """Make sure that the extra is there.

    Raises:
        UsageError: it is not.
    """
    try:
        import ray  # noqa: F401, PLC0415  an extra
    except ImportError:
        raise UsageError(
            "--executor ray needs a package that is missing: "
            'pip install "hsr8[ray]", or pip install ray'
        ) from None


class RayExecutor:
    """Jobs as Ray tasks, a CPU each.

    Args:
        address: ``HOST:PORT`` of a Ray client server; empty for a cluster on this machine,
            reachable from this machine only.
        workers: CPUs of the cluster on this machine.

    Raises:
        UsageError: the extra is missing, or nobody answers.
    """

    def __init__(self, address: str, workers: int) -> None:
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
        require_ray()
        import ray  # noqa: PLC0415  an extra

        self._ray: Any = ray
        try:
            if address:
                ray.init(f"ray://{address}", log_to_driver=False)
            else:
                ray.init(
                    num_cpus=workers,
                    include_dashboard=False,
                    log_to_driver=False,
                    logging_level="ERROR",
                    _node_ip_address="127.0.0.1",
                )
        except (OSError, ValueError, RuntimeError) as error:
            raise UsageError(f"--executor ray: the cluster does not start: {error}") from error
        if address and ray.get(ray.remote(code_digest).remote()) != code_digest():
            raise UsageError(
                f"--executor ray://{address}: the cluster runs other code than here: install the "
                "same version there"
            )
        # A run whose worker died is ours to retry, and to mark.
        self._work: Any = ray.remote(max_retries=0, scheduling_strategy="SPREAD")(work)
        self._running: dict[Any, Job] = {}
        self.workers = int(ray.cluster_resources().get("CPU", 1))

    def submit(self, job: Job) -> None:
        """Take a job."""
        self._running[self._work.remote(job)] = job

    def wait(self, seconds: float) -> list[tuple[Job, Row]]:
        """What has ended."""
        references = list(self._running)
        ended, _ = self._ray.wait(references, num_returns=len(references), timeout=seconds)
        return [self._row(reference) for reference in ended]

    def close(self) -> None:
        """Stop what still runs, and a cluster on this machine."""
        for reference in self._running:
            self._ray.cancel(reference, force=True)
        self._ray.shutdown()

    def _row(self, reference: Any) -> tuple[Job, Row]:
        job = self._running.pop(reference)
        try:
            row: Row = self._ray.get(reference)
        except self._ray.exceptions.RayError as error:
            row = lost(job, f"the worker went away: {error}")
        return job, row
