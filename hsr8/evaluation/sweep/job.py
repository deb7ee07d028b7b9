"""One run of a sweep: its command line and its result."""

import json
import os
import shutil
import signal
import socket
import time as clock
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from hsr8.files import atomic
from hsr8.recorder.run import run_folder

RunResult = dict[str, Any]
Keep = Literal["all", "failed", "none"]

CRASHED = "crashed"
REFUSED = "refused"
OUTCOMES = {0: "passed", 1: "failed", 3: "diverged"}  # by exit code
RUNS = "runs"  # run folders within a sweep's folder
MAX_ERROR = 2000  # characters kept of the messages of a run


@dataclass(frozen=True, slots=True)
class Job:
    """One run to do.

    Attributes:
        seed: seed of the run.
        folder: absolute path of the sweep's folder.
        scenario: resolved scenario as TOML.
        timeout: wall-clock limit [s].
        log: whether the run writes a Rerun log.
        keep: which run folders are kept.
        attempt: 1, or 2 after a crash.
        settings: KEY=VALUE of the plugins, which a file alone may not name.
    """

    seed: int
    folder: str
    scenario: str
    timeout: float
    log: bool = False
    keep: Keep = "all"
    attempt: int = 1
    settings: tuple[str, ...] = ()


class StartedJob:
    """Job whose process is being started.

    Args:
        job: the job.
        worker: name of the worker; host and process id by default.

    Attributes:
        arguments: command line of the run, without the program.
        messages: file for standard output and error of the run.

    Raises:
        OSError: the sweep's folder cannot be written.
    """

    def __init__(self, job: Job, worker: str = "") -> None:
        self.job = job
        self._folder = Path(job.folder)
        self._worker = worker or f"{socket.gethostname()}:{os.getpid()}"
        self._started = clock.perf_counter()
        runs, scenario = self._folder / RUNS, self._folder / run_folder.SCENARIO
        runs.mkdir(parents=True, exist_ok=True)
        if not scenario.exists():  # on a worker that does not share the disk
            atomic.write_text(scenario, job.scenario)
        self.messages = runs / f"{job.seed}.messages"
        self.arguments = ["run", str(scenario), "--seed", str(job.seed), "--out", str(runs)]
        self.arguments += ["--quiet"] if job.log else ["--quiet", "--no-log"]
        self.arguments += ["--set", *job.settings] if job.settings else []
        self._old_folders = set(self._run_folders())

    def result(self, exit_code: int, *, timed_out: bool = False) -> RunResult:
        """Return the result of the run, and remove the files that are not kept.

        A folder with a traceback is always kept, because the result names it.

        Args:
            exit_code: of the process, negative for a signal.
            timed_out: whether the process was killed at its wall-clock limit.

        Returns:
            ``seed``, ``outcome`` (passed, failed, diverged, crashed, refused), ``attempts``,
            ``worker``, ``run`` (folder relative to the sweep's), ``process_s``, ``error`` and all
            metrics of the run.
        """
        job = self.job
        new = next((path for path in self._run_folders() if path not in self._old_folders), None)
        result: RunResult = {
            "seed": job.seed,
            "outcome": CRASHED,
            "attempts": job.attempt,
            "worker": self._worker,
            "run": None if new is None else str(new.relative_to(self._folder)),
            "process_s": clock.perf_counter() - self._started,
        }
        message = self._message()
        metrics = _metrics(new)
        if timed_out:
            result["error"] = f"stopped at the wall-clock limit of {job.timeout:g} s"
        elif exit_code == 2 and new is None:
            result |= {"outcome": REFUSED, "error": message}
        elif exit_code in OUTCOMES and metrics is not None:
            result |= {"outcome": OUTCOMES[exit_code], **metrics}
            result |= {"error": message} if exit_code == 3 else {}
        else:
            result["error"] = ": ".join(filter(None, (_ending(exit_code), message)))
        kept = job.keep == "all" or (job.keep == "failed" and result["outcome"] != OUTCOMES[0])
        if new is not None and not kept and not (new / run_folder.CRASH).exists():
            shutil.rmtree(new, ignore_errors=True)
            result["run"] = None
        return result

    def _run_folders(self) -> list[Path]:
        return sorted((self._folder / RUNS).glob(f"*/{self.job.seed}-*"))

    def _message(self) -> str:
        try:
            text = self.messages.read_bytes().decode(errors="replace")
            self.messages.unlink()
        except OSError:
            return ""
        return text.strip()[-MAX_ERROR:]


def lost(job: Job, reason: str) -> RunResult:
    """Return the result of a run whose process did not start, or whose worker died."""
    return {
        "seed": job.seed,
        "outcome": CRASHED,
        "attempts": job.attempt,
        "worker": "",
        "run": None,
        "error": reason[-MAX_ERROR:],
    }


def _metrics(folder: Path | None) -> RunResult | None:
    """Return the metrics in a run folder, None for a run that did not end."""
    file = None if folder is None else folder / run_folder.METRICS
    metrics: RunResult | None = json.loads(file.read_bytes()) if file and file.exists() else None
    return metrics


def _ending(code: int) -> str:
    return f"killed by {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
