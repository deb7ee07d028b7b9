"""The folder of a sweep.

sweep.json           scenario, versions, command of one run
scenario.toml        resolved scenario, which `hsr8 run` accepts
runs/NAME/SEED-N/    run folder of the N-th attempt of a seed, with its `result.json`
runs.parquet         all results as a table
report.md            summary

Every process that starts the same sweep takes the seeds whose folders it creates.
"""

import io
import json
import os
import re
import shutil
import socket
import time as clock
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Self

from hsr8.errors import Hsr8Error, UsageError
from hsr8.files import atomic
from hsr8.files.tables import flatten
from hsr8.files.text import read_text
from hsr8.recording.run_folder import SCENARIO
from hsr8.sweep.definition import Definition, scenario_differences, version_differences
from hsr8.sweep.job import CLAIM, CRASHED, OUTCOMES, REFUSED, RESULT, Job, RunResult
from hsr8.sweep.summary import COUNTS, QUANTITIES

DEFINITION = "sweep.json"
RUNS = "runs"
TABLE = "runs.parquet"
REPORT = "report.md"
NUMBERS = (*(m.name for m in (*COUNTS, *QUANTITIES)), "attempts", "via_points_missed")
MAX_SHOWN = 12  # differences named in an error message
CLAIM_TIME = 60.0  # limit between the creation of a folder and its claim [s]


class SweepFolder:
    """Folder of a sweep.

    Args:
        path: path of the folder.
        definition: scenario and versions of its runs.
    """

    def __init__(self, path: Path, definition: Definition) -> None:
        self.path = path
        self.definition = definition
        self._runs = path / RUNS / definition.name

    @classmethod
    def read(cls, path: Path) -> Self:
        """Return the sweep at `path`.

        Raises:
            UsageError: the folder is not a sweep's, or is damaged.
        """
        file = path / DEFINITION
        try:
            return cls(path, Definition.from_json(json.loads(read_text(file))))
        except FileNotFoundError:
            raise UsageError(f"{path}: not a sweep, {file} is missing") from None
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            raise UsageError(f"{path}: cannot read {file}: {error}") from error

    @classmethod
    def open(cls, path: Path, definition: Definition) -> Self:
        """Return the sweep at `path`; create it if it does not exist.

        Raises:
            UsageError: the folder holds other runs, cannot be written, or leads out of itself.
        """
        for part in (path / RUNS, path / RUNS / definition.name):
            if part.is_symlink():
                raise UsageError(f"{part}: a link, got {os.readlink(part)}; expected a folder")
        try:
            path.mkdir(parents=True, exist_ok=True)
            if atomic.write_new(path / DEFINITION, atomic.dumps(asdict(definition), indent=2)):
                atomic.write_text(path / SCENARIO, definition.scenario)
                return cls(path, definition)
        except OSError as error:
            raise UsageError(
                f"{path}: cannot write the sweep: {error.strerror}; choose another with --out"
            ) from error
        folder = cls.read(path)
        old = folder.definition
        changed = scenario_differences(old, definition) | version_differences(old, definition)
        if changed:
            lines = [f"{key}: {there} there, {now} now" for key, (there, now) in changed.items()]
            more = len(lines) - MAX_SHOWN
            lines = lines[:MAX_SHOWN] + [f"and {more} more"] * (more > 0)
            lines.append("choose another folder with --out, or remove that one")
            raise UsageError("\n  ".join([f"{path}: holds runs of another sweep", *lines]))
        return folder

    def results(self) -> list[RunResult]:
        """Return the last result of every seed, by seed; crashes count least.

        Raises:
            UsageError: a result is damaged.
        """
        latest: dict[int, RunResult] = {}
        for seed, numbers in sorted(self._attempts().items()):
            for number in sorted(numbers):
                result = _result(self._attempt(seed, number) / RESULT)
                if result and (seed not in latest or result["outcome"] != CRASHED):
                    latest[seed] = result
        return list(latest.values())

    def missing(self, seeds: Sequence[int]) -> tuple[dict[int, int], int]:
        """Return the seeds to run, with the number of their next folder.

        These have no result, or crashed or were refused, and no other process runs them. The
        folder of a run whose process was killed is removed.

        Args:
            seeds: seeds of the whole sweep.

        Returns:
            Number of the next folder by seed, and the number of seeds that other processes run.
        """
        done = {r["seed"] for r in self.results() if r["outcome"] not in (CRASHED, REFUSED)}
        attempts, elsewhere = self._attempts(), 0
        missing = {}
        for seed in (seed for seed in seeds if seed not in done):
            last = max(attempts.get(seed, (0,)))
            folder = self._attempt(seed, last)
            if last and not (folder / RESULT).exists():
                if _is_claimed(folder):
                    elsewhere += 1
                    continue
                shutil.rmtree(folder, ignore_errors=True)
            missing[seed] = last + 1
        return missing, elsewhere

    def claim(self, seed: int, number: int, seconds: float) -> str | None:
        """Take a run by creating its folder.

        Args:
            seed: seed of the run.
            number: number of its folder, see `missing`.
            seconds: time after which other machines take the run to be lost [s].

        Returns:
            The folder, relative to the sweep's; None if another process was first.

        Raises:
            Hsr8Error: the folder cannot be written.
        """
        path, pid = self._attempt(seed, number), os.getpid()
        claim = {"host": socket.gethostname(), "pid": pid, "started": _start_of(pid)}
        try:
            path.mkdir(parents=True)
            atomic.write_json(path / CLAIM, {**claim, "until": clock.time() + seconds})
        except FileExistsError:
            return None
        except OSError as error:
            raise Hsr8Error(f"{path}: cannot write: {error.strerror}") from error
        return str(path.relative_to(self.path))

    def finish(self, job: Job, result: RunResult) -> None:
        """Write the result of a run that ended.

        Raises:
            Hsr8Error: the disk is full.
        """
        path = self.path / job.run
        try:
            path.mkdir(parents=True, exist_ok=True)
            atomic.write_text(path / RESULT, f"{atomic.dumps(result)}\n")
        except OSError as error:
            raise Hsr8Error(f"{path / RESULT}: cannot write: {error.strerror}") from error
        (path / CLAIM).unlink(missing_ok=True)

    def release(self, job: Job) -> None:
        """Leave a run that did not end to the next sweep."""
        shutil.rmtree(self.path / job.run, ignore_errors=True)

    def write_report(self, text: str) -> None:
        """Write the table of all results, and `text` as the report.

        Raises:
            Hsr8Error: they cannot be written.
        """
        try:
            write_table(self.path / TABLE, self.results())
            atomic.write_text(self.path / REPORT, text)
        except OSError as error:
            raise Hsr8Error(f"{self.path}: cannot write the report: {error.strerror}") from error

    def _attempts(self) -> dict[int, list[int]]:
        """Return the numbers of the run folders by seed."""
        attempts: dict[int, list[int]] = {}
        for name in os.listdir(self._runs) if self._runs.is_dir() else ():
            if match := re.fullmatch(r"(\d+)-(\d+)", name):
                attempts.setdefault(int(match[1]), []).append(int(match[2]))
        return attempts

    def _attempt(self, seed: int, number: int) -> Path:
        return self._runs / f"{seed}-{number}"


def _start_of(pid: int) -> str:
    """Return the start of a process since that of the machine; empty without such a process."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[19]
    except OSError:
        return ""


def _is_claimed(folder: Path) -> bool:
    """Return whether the process that claimed a folder runs, as far as this machine knows."""
    try:
        claim = json.loads(read_text(folder / CLAIM))
        if claim["host"] == socket.gethostname():
            return bool(_start_of(claim["pid"]) == claim["started"])
        return bool(clock.time() < claim["until"])
    except (OSError, ValueError, KeyError, TypeError):
        return folder.exists() and clock.time() < folder.stat().st_mtime + CLAIM_TIME


def _result(file: Path) -> RunResult | None:
    """Return a result; None if the run has not ended.

    Raises:
        UsageError: it is damaged.
    """
    try:
        result = json.loads(read_text(file))
        if type(result["seed"]) is not int:
            raise ValueError("not a result of a run")
        if result["outcome"] not in (*OUTCOMES.values(), CRASHED, REFUSED):
            raise ValueError(f"unknown outcome: {result['outcome']!r}")
        for key in NUMBERS:
            if not isinstance(result.get(key), int | float | None):
                raise ValueError(f"{key}: not a number: {result[key]!r}")
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise UsageError(f"cannot read {file}: {error}") from error
    return dict(result)


def write_table(path: Path, results: Sequence[RunResult]) -> None:
    """Write a Parquet table with a row per run.

    Missing values are null, columns of mixed types text, nested results dotted columns.
    """
    import pyarrow as pa  # noqa: PLC0415  takes half a second
    import pyarrow.parquet as pq  # noqa: PLC0415

    def column(values: list[Any]) -> Any:
        try:
            return pa.array(values)
        except (pa.ArrowInvalid, pa.ArrowTypeError, UnicodeEncodeError):
            texts = (None if v is None else str(v) for v in values)
            return pa.array(t and t.encode("utf-8", "backslashreplace").decode() for t in texts)

    rows = [flatten(result) for result in results]
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: column([row.get(name) for row in rows]) for name in names}
    content = io.BytesIO()
    pq.write_table(pa.table(columns), content)
    atomic.write_bytes(path, content.getvalue())
