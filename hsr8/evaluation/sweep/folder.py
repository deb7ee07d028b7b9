"""The folder of a sweep.

sweep.json       scenario's name, versions, the command of one run
scenario.toml    what was run, fully resolved; `hsr8 run` takes it
runs.jsonl       results, a run a line, written as the runs end
shard-I-of-N.jsonl   the same of a shard
runs.parquet     results of all ledgers as a table
report.md        what they come to
runs/            run folders
"""

import fcntl
import json
import os
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Self, TextIO

from hsr8.errors import Hsr8Error, UsageError
from hsr8.evaluation.sweep.definition import Definition, differences, version_differences
from hsr8.evaluation.sweep.job import CRASHED, OUTCOMES, REFUSED, Row
from hsr8.evaluation.sweep.summary import NUMBERS
from hsr8.evaluation.sweep.table import write_table
from hsr8.recorder.files import atomic
from hsr8.recorder.files.json_lines import read_lines
from hsr8.recorder.files.new_folder import require_new_folder
from hsr8.recorder.run.run_folder import SCENARIO

DEFINITION = "sweep.json"
LEDGER = "runs.jsonl"
TABLE = "runs.parquet"
REPORT = "report.md"


class SweepFolder:
    """A sweep's folder, open for reading, and for writing after `lock`.

    Args:
        path: of the folder.
        definition: what its runs have in common.
    """

    def __init__(self, path: Path, definition: Definition) -> None:
        self.path = path
        self.definition = definition
        self._ledger: TextIO | None = None

    @classmethod
    def read(cls, path: Path) -> Self:
        """The sweep at `path`.

        Raises:
            UsageError: there is none, or it is damaged.
        """
        file = path / DEFINITION
        try:
            value = json.loads(file.read_text(encoding="utf-8"))
            scenario = (path / SCENARIO).read_text(encoding="utf-8")
            return cls(path, Definition.from_json(value, scenario))
        except FileNotFoundError as error:
            raise UsageError(f"{path} holds no sweep: {error.filename} is missing") from None
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            raise UsageError(
                f"cannot read the sweep {path}: {file} or its {SCENARIO}: {error}"
            ) from error

    @classmethod
    def open(cls, path: Path, definition: Definition) -> Self:
        """The sweep at `path`, made if it is not there.

        Raises:
            UsageError: it holds runs of something else, or cannot be written.
        """
        try:
            path.mkdir(parents=True, exist_ok=True)
            with _alone(path):
                if (path / DEFINITION).exists():
                    there = cls.read(path)
                    _must_agree(path, there.definition, definition)
                    return there
                _must_hold_no_results(path)
                atomic.write_text(path / SCENARIO, definition.scenario)
                atomic.write_json(path / DEFINITION, definition.to_json())
        except OSError as error:
            raise UsageError(
                f"cannot write the sweep {path}: {error.strerror}; choose another with --out"
            ) from error
        return cls(path, definition)

    @classmethod
    def require(cls, path: Path, definition: Definition) -> None:
        """Make sure that `open` will do, and make nothing.

        Raises:
            UsageError: as `open`.
        """
        require_new_folder(path, "sweep")
        if (path / DEFINITION).exists():
            _must_agree(path, cls.read(path).definition, definition)
        else:
            _must_hold_no_results(path)

    def lock(self, shard: tuple[int, int] | None = None) -> None:
        """Open the ledger for writing; nobody else may write it until `close`.

        Raises:
            UsageError: somebody does, or it cannot be written.
        """
        name = LEDGER if shard is None else f"shard-{shard[0]}-of-{shard[1]}.jsonl"
        file = self.path / name
        try:
            with ExitStack() as undo:
                ledger = undo.enter_context(file.open("a+", encoding="utf-8"))
                fcntl.flock(ledger, fcntl.LOCK_EX | fcntl.LOCK_NB)
                _cut_torn_line(ledger)
                undo.pop_all()
        except BlockingIOError:
            raise UsageError(f"another sweep is writing {file}; wait, or stop it") from None
        except OSError as error:
            raise UsageError(f"cannot write {file}: {error.strerror}") from error
        self._ledger = ledger

    def rows(self) -> list[Row]:
        """The last word on every seed, over all ledgers, by seed.

        Raises:
            UsageError: a line is damaged.
        """
        found: dict[int, Row] = {}
        for file in sorted(self.path.glob("*.jsonl"), key=lambda file: file.name == LEDGER):
            for row in read_lines(file, _row):
                known = found.get(row["seed"])
                if known is None or known["outcome"] == CRASHED or row["outcome"] != CRASHED:
                    found[row["seed"]] = row
        return [found[seed] for seed in sorted(found)]

    def append(self, rows: Iterable[Row]) -> None:
        """Write the results of runs that ended.

        Raises:
            Hsr8Error: the disk takes no more.
        """
        assert self._ledger is not None, "lock comes first"
        try:
            self._ledger.write("".join(f"{atomic.dumps(row)}\n" for row in rows))
            self._ledger.flush()
            os.fsync(self._ledger.fileno())
        except OSError as error:
            raise Hsr8Error(f"cannot write {self._ledger.name}: {error.strerror}") from error

    def write_results(self, text: str) -> None:
        """Write the table of all rows, and `text` as the report.

        Raises:
            Hsr8Error: they cannot be written.
        """
        try:
            with _alone(self.path):
                write_table(self.path / TABLE, self.rows())
                atomic.write_text(self.path / REPORT, text)
        except OSError as error:
            raise Hsr8Error(f"cannot write in {self.path}: {error.strerror}") from error

    def close(self) -> None:
        """Let others write."""
        if self._ledger is not None:
            self._ledger.close()
            self._ledger = None


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Shards that begin or end at the same moment wait for each other."""
    handle = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def _must_agree(path: Path, there: Definition, now: Definition) -> None:
    """A folder holds the runs of one scenario and one program."""
    changed = {**differences(there, now), **version_differences(there, now)}
    if not changed:
        return
    shown = [f"  {key}: {old} there, {new} now" for key, (old, new) in list(changed.items())[:12]]
    more = [f"  and {len(changed) - 12} more"] if len(changed) > 12 else []
    lines = [f"{path} holds runs of something else", *shown, *more]
    raise UsageError("\n".join([*lines, "  choose another folder with --out, or remove that one"]))


def _must_hold_no_results(path: Path) -> None:
    """Of a sweep that nobody knows any more."""
    if any(path.glob("*.jsonl")):
        raise UsageError(f"{path} holds results but no {DEFINITION}; choose another with --out")


def _cut_torn_line(ledger: TextIO) -> None:
    """Remove what a kill left of a line."""
    raw = Path(ledger.name).read_bytes()
    whole = raw.rfind(b"\n") + 1
    if whole < len(raw):
        ledger.truncate(whole)


def _row(line: str) -> Row:
    try:
        row = json.loads(line)
    except RecursionError as error:
        raise ValueError("nested too deeply") from error
    if not isinstance(row, dict) or type(row["seed"]) is not int:
        raise ValueError("no result of a run")
    if row["outcome"] not in (*OUTCOMES.values(), CRASHED, REFUSED):
        raise ValueError(f"no outcome: {row['outcome']!r}")
    for key in NUMBERS:
        if not isinstance(row.get(key), int | float | None):
            raise ValueError(f"{key} is no number: {row[key]!r}")
    return row
