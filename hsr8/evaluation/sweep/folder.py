"""The folder of a sweep.

sweep.json           name of the scenario, versions, command of one run
scenario.toml        resolved scenario, which `hsr8 run` accepts
runs.jsonl           one result per line, written when the run ends
shard-I-of-N.jsonl   the results of one shard
runs.parquet         all results as a table
report.md            summary
runs/                run folders
"""

import fcntl
import io
import json
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self, TextIO

from hsr8.errors import Hsr8Error, UsageError
from hsr8.evaluation.sweep.definition import Definition, scenario_differences, version_differences
from hsr8.evaluation.sweep.job import CRASHED, OUTCOMES, REFUSED, RUNS, RunResult
from hsr8.evaluation.sweep.summary import COUNTS, QUANTITIES
from hsr8.evaluation.tables import flatten
from hsr8.files import atomic
from hsr8.files.json_lines import open_to_append, read_lines
from hsr8.files.text import read_text
from hsr8.recorder.run.run_folder import SCENARIO

DEFINITION = "sweep.json"
RESULTS = "runs.jsonl"
TABLE = "runs.parquet"
REPORT = "report.md"
NUMBERS = (*(m.name for m in (*COUNTS, *QUANTITIES)), "attempts", "via_points_missed")
MAX_SHOWN = 12  # differences named in an error message


class SweepFolder:
    """Folder of a sweep, open for reading, and for writing after `lock`.

    Args:
        path: path of the folder.
        definition: scenario and versions of its runs.
    """

    def __init__(self, path: Path, definition: Definition) -> None:
        self.path = path
        self.definition = definition
        self._file: TextIO | None = None

    @classmethod
    def read(cls, path: Path) -> Self:
        """Return the sweep at `path`.

        Raises:
            UsageError: the folder is not a sweep's, or is damaged.
        """
        file = path / DEFINITION
        try:
            value = json.loads(read_text(file))
            scenario = read_text(path / SCENARIO)
            return cls(path, Definition.from_json(value, scenario))
        except FileNotFoundError as error:
            raise UsageError(f"{path}: not a sweep, {error.filename} is missing") from None
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            raise UsageError(f"{path}: cannot read {file} or {SCENARIO}: {error}") from error

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
            with _locked(path):
                if cls.check(path, definition):
                    return cls.read(path)
                atomic.write_text(path / SCENARIO, definition.scenario)
                atomic.write_json(path / DEFINITION, definition.to_json())
        except OSError as error:
            raise UsageError(
                f"{path}: cannot write the sweep: {error.strerror}; choose another with --out"
            ) from error
        return cls(path, definition)

    @classmethod
    def check(cls, path: Path, definition: Definition) -> bool:
        """Return whether `path` holds this sweep already.

        Raises:
            UsageError: it holds other runs.
        """
        if not (path / DEFINITION).exists():
            if any(path.glob("*.jsonl")):
                raise UsageError(
                    f"{path}: has results but no {DEFINITION}; choose another with --out"
                )
            return False
        old = cls.read(path).definition
        changed = scenario_differences(old, definition) | version_differences(old, definition)
        if changed:
            lines = [f"{key}: {there} there, {now} now" for key, (there, now) in changed.items()]
            more = len(lines) - MAX_SHOWN
            lines = lines[:MAX_SHOWN] + [f"and {more} more"] * (more > 0)
            lines.append("choose another folder with --out, or remove that one")
            raise UsageError("\n  ".join([f"{path}: holds runs of another sweep", *lines]))
        return True

    def lock(self, shard: tuple[int, int] | None = None) -> None:
        """Open the file of results for writing, exclusively until `close`.

        Raises:
            UsageError: another process writes it, or it cannot be written.
        """
        name = RESULTS if shard is None else f"shard-{shard[0]}-of-{shard[1]}.jsonl"
        path = self.path / name
        try:
            self._file = open_to_append(path)
        except BlockingIOError:
            raise UsageError(f"{path}: another sweep writes this file; wait or stop it") from None
        except OSError as error:
            raise UsageError(f"{path}: cannot write: {error.strerror}") from error

    def results(self) -> list[RunResult]:
        """Return the last result of every seed over all files, by seed; crashes count least.

        Raises:
            UsageError: a line is damaged.
        """
        latest: dict[int, RunResult] = {}
        for file in sorted(self.path.glob("*.jsonl"), key=lambda file: file.name == RESULTS):
            for result in read_lines(file, _parse):
                known = latest.get(result["seed"])
                if known is None or known["outcome"] == CRASHED or result["outcome"] != CRASHED:
                    latest[result["seed"]] = result
        return [latest[seed] for seed in sorted(latest)]

    def append(self, *results: RunResult) -> None:
        """Write results of runs that ended.

        Raises:
            Hsr8Error: the disk is full.
        """
        assert self._file is not None, "lock comes first"
        try:
            self._file.writelines(f"{atomic.dumps(result)}\n" for result in results)
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise Hsr8Error(f"{self._file.name}: cannot write: {error.strerror}") from error

    def write_report(self, text: str) -> None:
        """Write the table of all results, and `text` as the report.

        Raises:
            Hsr8Error: they cannot be written.
        """
        try:
            with _locked(self.path):
                write_table(self.path / TABLE, self.results())
                atomic.write_text(self.path / REPORT, text)
        except OSError as error:
            raise Hsr8Error(f"{self.path}: cannot write the report: {error.strerror}") from error

    def close(self) -> None:
        """Release the lock."""
        if self._file is not None:
            self._file.close()
            self._file = None


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Lock a folder against shards that start or end at the same time."""
    handle = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def _parse(line: str) -> RunResult:
    try:
        result = json.loads(line)
    except RecursionError as error:
        raise ValueError("nested too deeply") from error
    if not isinstance(result, dict) or type(result["seed"]) is not int:
        raise ValueError("not a result of a run")
    if result["outcome"] not in (*OUTCOMES.values(), CRASHED, REFUSED):
        raise ValueError(f"unknown outcome: {result['outcome']!r}")
    for key in NUMBERS:
        if not isinstance(result.get(key), int | float | None):
            raise ValueError(f"{key}: not a number: {result[key]!r}")
    return result


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
