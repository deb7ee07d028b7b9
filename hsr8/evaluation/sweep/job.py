"""One run of a sweep: what a worker is given, does, and hands back."""

import json
import os
import shutil
import signal
import socket
import subprocess
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from hsr8.evaluation.sweep.process import Process
from hsr8.recorder.files import atomic
from hsr8.recorder.run import run_folder

Row = dict[str, Any]
Keep = Literal["all", "failed", "none"]
Start = Callable[[Sequence[str]], Process]

CRASHED = "crashed"
REFUSED = "refused"
OUTCOMES = {0: "passed", 1: "failed", 3: "diverged"}
RUNS = "runs"  # run folders within a sweep's folder
SAID = 2000  # characters kept of what a crashed run said


@dataclass(frozen=True, slots=True)
class Job:
    """One run.

    Attributes:
        seed: of the run.
        folder: absolute path of the sweep's folder.
        scenario: the resolved scenario as TOML.
        timeout: wall time after which the run hangs [s].
        log: whether it writes a Rerun log.
        keep: which run folders stay.
        attempt: 1, or 2 for one that crashed before.
        avoid: worker it crashed on.
    """

    seed: int
    folder: str
    scenario: str
    timeout: float
    log: bool = False
    keep: Keep = "all"
    attempt: int = 1
    avoid: str = ""


def run_job(job: Job, start: Start, worker: str = "") -> Row:
    """Run `job` in a process of its own and wait for it.

    Args:
        job: what to run.
        start: makes the process of a command line.
        worker: name that a retry avoids; host and process by default.

    Returns:
        The row of the results: ``seed``, ``outcome`` (passed, failed, diverged, crashed,
        refused), ``attempts``, ``worker``, ``run`` (folder within the sweep's), ``error``, and
        all metrics of the run.
    """
    folder = Path(job.folder)
    file = folder / run_folder.SCENARIO
    if not file.exists():  # a worker that does not share the disk
        folder.mkdir(parents=True, exist_ok=True)
        atomic.write_text(file, job.scenario)
    before = set(_folders(job))
    began = clock.perf_counter()
    process = start(_words(job, file))
    hung = False
    try:
        printed, said = process.communicate(timeout=job.timeout)
    except subprocess.TimeoutExpired:
        hung = True
        process.kill()
        printed, said = process.communicate()
    made = next((path for path in _folders(job) if path not in before), None)
    row: Row = {
        "seed": job.seed,
        "outcome": CRASHED,
        "attempts": job.attempt,
        "worker": worker or f"{socket.gethostname()}:{os.getpid()}",
        "run": None if made is None else str(made.relative_to(folder)),
        "process_s": clock.perf_counter() - began,
    }
    assert process.returncode is not None, "it has ended"
    row |= _result(process.returncode, printed, said, job.timeout if hung else None)
    if row["outcome"] == REFUSED and made is not None:
        row["outcome"] = CRASHED  # it began to walk, and a planner or a gaze of one's own erred
    if made is not None and not _kept(job.keep, row["outcome"]):
        shutil.rmtree(made, ignore_errors=True)
        row["run"] = None
    return row


def lost(job: Job, reason: str) -> Row:
    """Row of a run whose worker went away with it."""
    return {
        "seed": job.seed,
        "outcome": CRASHED,
        "attempts": job.attempt,
        "worker": job.avoid,
        "run": None,
        "error": reason[-SAID:],
    }


def _words(job: Job, file: Path) -> list[str]:
    words = ["run", str(file), "--seed", str(job.seed), "--out", str(Path(job.folder) / RUNS)]
    words += ["--json", "--quiet"]
    return words if job.log else [*words, "--no-log"]


def _folders(job: Job) -> list[Path]:
    return sorted((Path(job.folder) / RUNS).glob(f"*/{job.seed}-*"))


def _kept(keep: Keep, outcome: str) -> bool:
    return keep == "all" or (keep == "failed" and outcome != OUTCOMES[0])


def _result(code: int, printed: str, said: str, limit: float | None) -> Row:
    """What the run's exit code and output come to."""
    said = said.strip()[-SAID:]
    if limit is not None:
        return {"error": f"no end after {limit:.0f} s of wall time"}
    if code == 2:
        return {"outcome": REFUSED, "error": said}
    try:
        metrics = json.loads(printed)
    except ValueError:
        metrics = None
    if not isinstance(metrics, dict) or code not in OUTCOMES:
        return {"error": f"{_ending(code)}{': ' if said else ''}{said}"}
    return {"outcome": OUTCOMES[code], **metrics} | ({"error": said} if code == 3 else {})


def _ending(code: int) -> str:
    if code >= 0:
        return f"exit code {code}"
    try:
        return f"killed by {signal.Signals(-code).name}"
    except ValueError:
        return f"killed by signal {-code}"
