"""Drives the jobs of sweeps through an executor."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from hsr8.evaluation.sweep.executor import Executor
from hsr8.evaluation.sweep.job import CRASHED, REFUSED, Job, Row

ATTEMPTS = 2  # a crashed run is tried again once
POLL = 0.5  # time between two looks at the clock [s]


def drive(
    jobs: Sequence[Job],
    executor: Executor,
    record: Callable[[Job, Row], None],
    tick: Callable[[], None],
) -> None:
    """Run all jobs; one that crashes is run again, elsewhere if there is an elsewhere.

    Args:
        jobs: to run.
        executor: runs them; it is left open.
        record: told of every result.
        tick: called every half second at least.
    """
    for job in jobs:
        executor.submit(job)
    left = len(jobs)
    errors: dict[tuple[str, int], str] = {}
    while left:
        for job, row in executor.wait(POLL):
            key = (job.folder, job.seed)
            if row["outcome"] == CRASHED and job.attempt < ATTEMPTS:
                errors[key] = str(row.get("error"))
                executor.submit(replace(job, attempt=job.attempt + 1, avoid=row["worker"]))
                continue
            first = {"first_error": errors[key]} if key in errors else {}
            record(job, row | first)
            left -= 1
        tick()


def pending(
    seeds: Sequence[int], rows: Sequence[Row], shard: tuple[int, int] | None
) -> tuple[int, ...]:
    """Seeds that are still to be run: those of the shard without a result, or that crashed.

    Args:
        seeds: of the whole sweep.
        rows: results so far.
        shard: number, from 1, and count of shards; every seed belongs to one of them.
    """
    done = {row["seed"] for row in rows if row["outcome"] not in (CRASHED, REFUSED)}
    mine = seeds if shard is None else seeds[shard[0] - 1 :: shard[1]]
    return tuple(seed for seed in mine if seed not in done)
