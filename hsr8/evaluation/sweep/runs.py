"""Runs of one or more sweep folders, and the executors that run their jobs."""

import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.dask_executor import DaskExecutor
from hsr8.evaluation.sweep.definition import Definition
from hsr8.evaluation.sweep.folder import SweepFolder
from hsr8.evaluation.sweep.job import CRASHED, REFUSED, Job, Keep, RunResult
from hsr8.evaluation.sweep.local_executor import LocalExecutor
from hsr8.evaluation.sweep.progress import SweepProgress
from hsr8.evaluation.sweep.report import report
from hsr8.files.writing import require_temporary
from hsr8.gl import require_gl
from hsr8.plugin_file import require_plugins
from hsr8.scenario.schema import Scenario

START_TIME = 60.0  # default limits: for the start of a process [s]
MAX_SLOWNESS = 20.0  # and wall time per simulated second [1]
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Execution:
    """How runs are executed.

    Attributes:
        command: command line that continues them.
        seeds: seeds of every sweep.
        shard: number, from 1, and count of shards; None for all seeds.
        workers: parallel runs on this machine; None for the number of CPUs.
        executor: "local" or "dask://HOST:PORT".
        timeout: wall-clock limit per run [s]; None for the default.
        keep: run folders that are kept.
        quiet: whether no progress is shown.

    Raises:
        UsageError: an option is invalid.
    """

    command: str
    seeds: tuple[int, ...]
    shard: tuple[int, int] | None = None
    workers: int | None = None
    executor: str = "local"
    timeout: float | None = None
    keep: Keep = "all"
    quiet: bool = False

    def __post_init__(self) -> None:
        if self.workers is not None and self.workers < 1:
            raise UsageError(f"--workers: out of range, got {self.workers}; expected at least 1")
        if self.timeout is not None and not self.timeout > 0.0:
            raise UsageError(
                f"--timeout: out of range, got {self.timeout:g}; expected more than 0 s"
            )
        parse_executor(self.executor)


@dataclass(frozen=True, slots=True)
class SweepRuns:
    """Results of sweeps.

    Attributes:
        results: results of all seeds in the folder, by name of the sweep.
        definition: definition of one of them, with the versions.
        interrupted: whether the runs were interrupted.
    """

    results: dict[str, list[RunResult]]
    definition: Definition
    interrupted: bool


def run_sweeps(
    out: Path,
    scenarios: Mapping[str, Scenario],
    commands: Mapping[str, tuple[str, ...]],
    execution: Execution,
) -> SweepRuns:
    """Execute the runs without a result and write the results and a report of every sweep.

    Args:
        out: parent of the folders of the sweeps.
        scenarios: scenario by name of the folder; an empty name is `out` itself.
        commands: command line of one run without its seed, by name of the folder.
        execution: how to execute the runs.

    Raises:
        UsageError: a plugin cannot be read or made, or a folder is invalid.
        RenderingUnavailable: the camera needs OpenGL and there is none.
    """
    local = not parse_executor(execution.executor)
    if local and any(s.camera.source == "rendered" for s in scenarios.values()):
        require_gl()
    if local:
        require_temporary()  # of the server that forks the runs
    for scenario in scenarios.values():
        require_plugins(scenario.plugin)
    folders: dict[str, SweepFolder] = {}
    jobs: list[Job] = []
    with ExitStack() as stack:
        for name, scenario in scenarios.items():
            folder = SweepFolder.open(out / name, Definition.now(scenario, commands[name]))
            folder.lock(execution.shard)
            stack.callback(folder.close)
            folders[name] = folder
            limit = execution.timeout or START_TIME + MAX_SLOWNESS * scenario.duration
            jobs += [
                Job(
                    scenario.with_seed(seed),
                    str(folder.path.resolve()),
                    folder.definition.command(seed),
                    limit,
                    keep=execution.keep,
                )
                for seed in pending(execution.seeds, folder.results(), execution.shard)
            ]
        interrupted = bool(jobs) and _run(jobs, list(folders.values()), execution)
        results = {name: folder.results() for name, folder in folders.items()}
        for name, folder in folders.items():
            folder.write_report(report(folder.definition, results[name], execution.command))
    if interrupted:
        print(f"hsr8: interrupted; continue with: {execution.command}", file=sys.stderr)
    return SweepRuns(results, folder.definition, interrupted)


def _run(jobs: Sequence[Job], folders: Sequence[SweepFolder], execution: Execution) -> bool:
    """Run the jobs; return whether they were interrupted."""
    total = len(pending(execution.seeds, (), execution.shard)) * len(folders)
    progress = None if execution.quiet else SweepProgress(total, total - len(jobs))
    by_path = {str(folder.path.resolve()): folder for folder in folders}

    def on_result(job: Job, result: RunResult) -> None:
        folder = by_path[job.folder]
        folder.append(result | {"command": job.command})
        if progress is not None:
            progress.on_result(result, folder.path.name if len(folders) > 1 else "")

    with ExitStack() as stack:
        if progress is not None:
            stack.callback(progress.close)
        try:
            executor = open_executor(execution.executor, execution.workers)
            stack.enter_context(closing(executor))
            run_jobs(jobs, executor, on_result, progress.refresh if progress else lambda: None)
        except KeyboardInterrupt:
            return True
    return False


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


def open_executor(name: str, workers: int | None) -> Executor:
    """Return the executor called `name`.

    Args:
        name: "local" or "dask://HOST:PORT".
        workers: parallel runs on this machine; None for the number of CPUs.
    """
    address = parse_executor(name)
    if address:
        return DaskExecutor(address)
    return LocalExecutor(workers or len(os.sched_getaffinity(0)))
