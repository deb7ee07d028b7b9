"""Runs of one or more sweep folders."""

import sys
from collections import deque
from collections.abc import Mapping
from contextlib import ExitStack, closing
from dataclasses import dataclass, replace
from pathlib import Path

from hsr8.errors import Hsr8Error, UsageError
from hsr8.files.atomic import require_temporary
from hsr8.plugins.file import require_plugins
from hsr8.process.gl import require_gl
from hsr8.scenario.schema import Scenario
from hsr8.sweep.definition import Definition
from hsr8.sweep.folder import SweepFolder
from hsr8.sweep.job import CRASHED, Job, Keep, RunResult
from hsr8.sweep.pools import open_pool, parse_executor
from hsr8.sweep.progress import SweepProgress
from hsr8.sweep.report import report

START_TIME = 60.0  # default limits: for the start of a process [s]
MAX_SLOWNESS = 20.0  # and wall time per simulated second [1]
ATTEMPTS = 2  # a crashed run is repeated once
POLL = 0.5  # interval of the progress display [s]
QUEUED = 3  # limits after which other machines take a run to be lost


@dataclass(frozen=True, slots=True, kw_only=True)
class Execution:
    """How runs are executed.

    Attributes:
        command: command line that continues them.
        seeds: seeds of every sweep.
        workers: parallel runs on this machine; None for the number of CPUs.
        executor: "local" or "dask://HOST:PORT".
        timeout: wall-clock limit per run [s]; None for the default.
        keep: runs whose tables are kept.
        quiet: whether no progress is shown.

    Raises:
        UsageError: an option is invalid.
    """

    command: str
    seeds: tuple[int, ...]
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
        Hsr8Error: a folder can no longer be written, or the scheduler was lost.
    """
    if not parse_executor(execution.executor):
        if any(s.camera.source == "rendered" for s in scenarios.values()):
            require_gl()
        require_temporary()  # of the server that forks the runs
    for scenario in scenarios.values():
        require_plugins(scenario.plugin)
    folders = {
        name: SweepFolder.open(out / name, Definition.now(scenario, commands[name]))
        for name, scenario in scenarios.items()
    }
    waiting, elsewhere = _missing(folders, scenarios, execution)
    interrupted = False
    try:
        if waiting:
            _run(waiting, execution, len(folders))
    except KeyboardInterrupt:
        interrupted = True
        print(f"hsr8: interrupted; continue with: {execution.command}", file=sys.stderr)
    except Hsr8Error as error:
        error.add_note(f"continue with: {execution.command}")
        raise
    results = {name: folder.results() for name, folder in folders.items()}
    for name, folder in folders.items():
        folder.write_report(report(folder.definition, results[name], execution.command))
    if elsewhere:
        print(
            f"hsr8: {elsewhere} runs belong to other processes; the last one reports all runs",
            file=sys.stderr,
        )
    return SweepRuns(results, next(iter(folders.values())).definition, interrupted)


@dataclass(slots=True)
class _Run:
    """Run without a result.

    Attributes:
        folder: folder of its sweep.
        job: the run.
        number: number of its next folder.
        first_error: error of the first attempt, if it crashed.
    """

    folder: SweepFolder
    job: Job
    number: int
    first_error: str = ""

    def claim(self) -> bool:
        """Take the run; return False if another process has done so."""
        folder = self.folder.claim(self.job.seed, self.number, QUEUED * self.job.timeout)
        self.job = replace(self.job, run=folder or "")
        return folder is not None

    def again(self, error: str) -> "_Run":
        """Return the second attempt."""
        job = replace(self.job, attempt=self.job.attempt + 1)
        return _Run(self.folder, job, self.number + 1, error)


def _missing(
    folders: Mapping[str, SweepFolder], scenarios: Mapping[str, Scenario], execution: Execution
) -> tuple[deque[_Run], int]:
    """Return the runs without a result, and the number of runs of other processes."""
    waiting, elsewhere = deque[_Run](), 0
    for name, folder in folders.items():
        missing, others = folder.missing(execution.seeds)
        elsewhere += others
        limit = execution.timeout or START_TIME + MAX_SLOWNESS * scenarios[name].duration
        path = str(folder.path.resolve())
        for seed, number in missing.items():
            scenario, command = scenarios[name].with_seed(seed), folder.definition.command(seed)
            job = Job(scenario, path, "", command, limit, keep=execution.keep)
            waiting.append(_Run(folder, job, number))
    return waiting, elsewhere


def _run(waiting: deque[_Run], execution: Execution, sweeps: int) -> None:
    """Run all that no other process takes first; repeat a crashed run once.

    Raises:
        KeyboardInterrupt: Ctrl-C or SIGTERM; the runs that were stopped are left to the next
            sweep, also after an error.
        Hsr8Error: a folder can no longer be written, or the scheduler was lost.
    """
    total, running = len(execution.seeds) * sweeps, dict[tuple[str, int], _Run]()
    with ExitStack() as stack:
        progress = None
        if not execution.quiet:
            progress = SweepProgress(total, total - len(waiting))
            stack.callback(progress.close)
        stack.callback(_release, running)
        pool = stack.enter_context(closing(open_pool(execution.executor, execution.workers)))
        while waiting or running:
            while waiting and pool.free > 0:
                run = waiting.popleft()
                if run.claim():
                    running[run.job.folder, run.job.seed] = run
                    pool.submit(run.job)
            for job, result in pool.wait(POLL) if running or waiting else ():
                run = running[job.folder, job.seed]
                again = result["outcome"] == CRASHED and job.attempt < ATTEMPTS
                if again:
                    waiting.append(run.again(str(result.get("error"))))
                elif run.first_error:
                    result["first_error"] = run.first_error
                run.folder.finish(job, result | {"command": job.command})
                del running[job.folder, job.seed]
                if progress is not None and not again:
                    progress.on_result(result, run.folder.path.name if sweeps > 1 else "")
            if progress is not None:
                progress.refresh()


def _release(running: Mapping[tuple[str, int], _Run]) -> None:
    """Leave runs that did not end to the next sweep."""
    for run in running.values():
        run.folder.release(run.job)
