"""One run of a sweep: a function that the process of the run calls, and its result."""

import os
import shutil
import signal
import socket
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from hsr8.errors import Hsr8Error
from hsr8.evaluation.crash import FILE, crash_report
from hsr8.evaluation.recording import Result, record, renderer_of
from hsr8.evaluation.verdict import exit_code
from hsr8.loop import Simulation
from hsr8.recorder.run.run_folder import RunFolder, new_run_folder
from hsr8.scenario.schema import Scenario

RunResult = dict[str, Any]
"""``seed``, ``outcome`` (passed, failed, diverged, crashed, refused), ``attempts``, ``worker``,
``run`` (folder relative to the sweep's), ``process_s``, ``error``, and all metrics of the run."""
Keep = Literal["all", "failed", "none"]

CRASHED = "crashed"
REFUSED = "refused"
OUTCOMES = {0: "passed", 1: "failed", 3: "diverged"}  # by exit code of ``hsr8 run``
RUNS = "runs"  # run folders within a sweep's folder
MAX_ERROR = 2000  # characters kept of the message of a run


@dataclass(frozen=True, slots=True)
class Job:
    """One run to do.

    Attributes:
        scenario: scenario with the seed of the run.
        folder: absolute path of the sweep's folder.
        command: command line that repeats the run.
        timeout: wall-clock limit [s].
        keep: run folders that are kept.
        attempt: 1, or 2 after a crash.
    """

    scenario: Scenario
    folder: str
    command: str
    timeout: float
    keep: Keep = "all"
    attempt: int = 1

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.scenario.name

    @property
    def seed(self) -> int:
        """Seed of the run."""
        return self.scenario.seed


def run_job(job: Job) -> Iterator[RunResult]:
    """Do a run in this process, which SIGTERM ends after the current tick.

    Yields:
        Parts of the result as soon as they are known, see `RunResult`: ``run``, then all others.
    """
    path = None
    try:
        with crash_report(), new_run_folder(Path(job.folder) / RUNS, job.name, job.seed) as path:
            yield {"run": str(path.relative_to(job.folder))}
            yield _result(_record(job, path))
    except Hsr8Error as error:
        refused = error.exit_code == 2 and (path is None or not path.exists())
        yield {"outcome": REFUSED if refused else CRASHED, "error": str(error)[-MAX_ERROR:]}
    except OSError as error:  # a full disk
        yield {"outcome": CRASHED, "error": f"cannot write: {error.strerror}"}


def _record(job: Job, path: Path) -> Result:
    """Record the run into a new folder."""
    renderer = renderer_of(job.scenario)
    simulation = Simulation(job.scenario, job.seed)
    signal.signal(signal.SIGTERM, lambda *_: simulation.interrupt())
    with crash_report(path):
        folder = RunFolder(path, job.scenario, (job.command,), renderer)
        return record(simulation, folder)


def _result(result: Result) -> RunResult:
    """Return the outcome and the metrics of a run that ended."""
    code = exit_code(result.exit_reason, result.criteria)
    if code not in OUTCOMES:
        return {"outcome": CRASHED, "error": result.exit_reason, **result.metrics}
    error = {"error": result.diverged} if result.diverged else {}
    return {"outcome": OUTCOMES[code], **error, **result.metrics}


def complete(job: Job, result: RunResult) -> RunResult:
    """Return the result of a run that has ended; remove its folder if it is not kept.

    A folder with a traceback is always kept, because the result names it.

    Args:
        job: the run.
        result: all parts that are known.
    """
    if result["run"] is None:
        return result
    path = Path(job.folder) / result["run"]
    kept = job.keep == "all" or (job.keep == "failed" and result["outcome"] != OUTCOMES[0])
    if not kept and not (path / FILE).exists():
        shutil.rmtree(path, ignore_errors=True)
    return result if path.exists() else {**result, "run": None}


def unfinished(job: Job, error: str = "") -> RunResult:
    """Return the result of a run that has not ended, or was lost with its process."""
    return {
        "seed": job.seed,
        "outcome": CRASHED,
        "attempts": job.attempt,
        "worker": f"{socket.gethostname()}:{os.getpid()}",
        "run": None,
        **({"error": error[-MAX_ERROR:]} if error else {}),
    }
