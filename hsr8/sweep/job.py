"""One run of a sweep: a function that the process of the run calls, and its result."""

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from hsr8.driver import run_scenario
from hsr8.errors import Hsr8Error
from hsr8.recording.crash import FILE, crash_report
from hsr8.recording.run import Run
from hsr8.recording.run_folder import MANIFEST
from hsr8.recording.verdict import exit_code
from hsr8.scenario.schema import Scenario

RunResult = dict[str, Any]
"""``seed``, ``outcome`` (passed, failed, diverged, crashed, refused), ``attempts``, ``worker``,
``run`` (folder relative to the sweep's), ``process_s``, ``error``, and all metrics of the run."""
Keep = Literal["all", "failed", "none"]

CRASHED = "crashed"
REFUSED = "refused"
OUTCOMES = {0: "passed", 1: "failed", 3: "diverged"}  # by exit code of ``hsr8 run``
RESULT = "result.json"  # in the folder of a run
CLAIM = "claim.json"  # in the folder of a run that has no result yet
MAX_ERROR = 2000  # characters kept of the message of a run


@dataclass(frozen=True, slots=True)
class Job:
    """One run to do.

    Attributes:
        scenario: scenario with the seed of the run.
        folder: absolute path of the sweep's folder.
        run: folder of the run, relative to that of the sweep.
        command: command line that repeats the run.
        timeout: wall-clock limit [s].
        keep: runs whose tables are kept.
        attempt: 1, or 2 after a crash.
    """

    scenario: Scenario
    folder: str
    run: str
    command: str
    timeout: float
    keep: Keep = "all"
    attempt: int = 1

    @property
    def seed(self) -> int:
        """Seed of the run."""
        return self.scenario.seed

    @property
    def path(self) -> Path:
        """Absolute path of the folder of the run."""
        return Path(self.folder, self.run)


def run_job(job: Job) -> RunResult:
    """Do a run in this process, which SIGTERM ends after the current tick; see `RunResult`."""
    path = job.path
    try:
        path.mkdir(parents=True, exist_ok=True)  # a cluster may have no shared disk
        with crash_report(path):
            return _result(run_scenario(job.scenario, path, (job.command,)))
    except Hsr8Error as error:
        refused = error.exit_code == 2 and not (path / MANIFEST).exists()
        return {"outcome": REFUSED if refused else CRASHED, "error": str(error)[-MAX_ERROR:]}
    except OSError as error:
        return {"outcome": CRASHED, "error": f"cannot write: {error.strerror}"}


def _result(run: Run) -> RunResult:
    """Return the outcome and the metrics of a run that ended."""
    code = exit_code(run.exit_reason, run.criteria)
    if code not in OUTCOMES:
        return {"outcome": CRASHED, "error": run.exit_reason, **run.metrics}
    error = {"error": run.diverged} if run.diverged else {}
    return {"outcome": OUTCOMES[code], **error, **run.metrics}


def prune(job: Job, result: RunResult) -> RunResult:
    """Remove the files of a run that are not kept; return the result with its folder.

    A folder with a traceback is always kept, because the result names it.
    """
    kept = job.keep == "all" or (job.keep == "failed" and not result.get("success"))
    if (job.path / FILE).exists() or (kept and (job.path / MANIFEST).exists()):
        return {**result, "run": job.run}
    for file in job.path.iterdir() if job.path.is_dir() else ():
        if file.name != CLAIM:
            shutil.rmtree(file) if file.is_dir() else file.unlink()
    return {**result, "run": None}


def unfinished(job: Job, error: str) -> RunResult:
    """Return the result of a run that was lost with its process."""
    result = {"seed": job.seed, "outcome": CRASHED, "attempts": job.attempt, "run": None}
    return {**result, "error": error[-MAX_ERROR:]}
