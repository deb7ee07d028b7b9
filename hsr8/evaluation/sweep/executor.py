"""Executors of the jobs of a sweep, and the loop that drives them."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.job import CRASHED, REFUSED, Job, RunResult

ATTEMPTS = 2  # a crashed run is repeated once
POLL = 0.5  # interval of the progress display [s]


class Executor(Protocol):
    """Runs jobs, as many at a time as it has workers."""

    def submit(self, job: Job) -> None:
        """Add a job; it starts when a worker is free."""

    def wait(self, seconds: float) -> list[tuple[Job, RunResult]]:
        """Return the jobs that ended; wait up to `seconds` for the first."""

    def close(self) -> None:
        """Stop the jobs that still run."""


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


def run_jobs(
    jobs: Sequence[Job],
    executor: Executor,
    on_result: Callable[[Job, RunResult], None],
    on_poll: Callable[[], None],
) -> None:
    """Run all jobs; repeat a crashed one once.

    Args:
        jobs: the jobs.
        executor: runs the jobs; it stays open.
        on_result: called with every result.
        on_poll: called at least every half second.
    """
    for job in jobs:
        executor.submit(job)
    remaining = len(jobs)
    first_errors: dict[tuple[str, int], str] = {}
    while remaining:
        for job, result in executor.wait(POLL):
            key = (job.folder, job.seed)
            if result["outcome"] == CRASHED and job.attempt < ATTEMPTS:
                first_errors[key] = str(result.get("error"))
                executor.submit(replace(job, attempt=job.attempt + 1))
                continue
            if key in first_errors:
                result["first_error"] = first_errors[key]
            on_result(job, result)
            remaining -= 1
        on_poll()


def pending(
    seeds: Sequence[int], results: Sequence[RunResult], shard: tuple[int, int] | None
) -> tuple[int, ...]:
    """Return the seeds of the shard that have no result, or that crashed or were refused.

    Args:
        seeds: seeds of the whole sweep.
        results: results so far.
        shard: number, from 1, and count of shards; every seed belongs to one of them.
    """
    done = {r["seed"] for r in results if r["outcome"] not in (CRASHED, REFUSED)}
    mine = seeds if shard is None else seeds[shard[0] - 1 :: shard[1]]
    return tuple(seed for seed in mine if seed not in done)
