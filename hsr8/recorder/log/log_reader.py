"""The Rerun log of a run read back into arrays, also that of a run that was killed."""

import subprocess
import sys
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from rerun.chunk import RrdReader

from hsr8.errors import UsageError
from hsr8.recorder.log.channel import TIMELINE
from hsr8.recorder.run.run_reader import Run, open_run
from hsr8.suggestion import suggestion

Array = NDArray[np.float64]

NANOSECOND = 1e-9  # [s]
NAMES = "SeriesLines:names"


@dataclass(frozen=True, slots=True)
class LogTable:
    """One component of one entity over time.

    Attributes:
        entity: for example ``/plots/partial``.
        component: for example ``Scalars:scalars``.
        time: of each row (n,) [s]; -inf for what was logged once and holds always.
        rows: n arrays, one element per instance; lists of arrays where the instances differ
            in length, as those of lines do.
        names: of the curves; empty for what is no plot.
    """

    entity: str
    component: str
    time: Array
    rows: tuple[Any, ...]
    names: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.time)

    def array(self) -> NDArray[Any]:
        """All rows in one array (n, instances, ...).

        Raises:
            ValueError: they have different numbers of instances.
        """
        shapes = {np.shape(row) for row in self.rows}
        if len(shapes) > 1:
            raise ValueError(f"{self.entity}: the rows have different lengths; take them from rows")
        return np.array(self.rows)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """One curve of a plot (n,).

        Raises:
            KeyError: there is no such curve.
        """
        if name not in self.names:
            raise KeyError(f"{self.entity} has no curve {name!r}, but {', '.join(self.names)}")
        curve: NDArray[Any] = self.array()[:, self.names.index(name)]
        return curve


class Log:
    """The log of a run.

    Args:
        files: its parts in their order; of a run that was resumed, each goes on where the one
            before was when its checkpoint was made.

    Raises:
        UsageError: there is none.
    """

    def __init__(self, files: Sequence[Path]) -> None:
        if not files:
            raise UsageError("the run has no log: it was run with --no-log")
        self._files = tuple(files)

    def entities(self) -> dict[str, tuple[str, ...]]:
        """Components of every entity, by its path."""
        found: dict[str, dict[str, None]] = {}
        for file in self._files:
            for chunk in _chunks(file):
                names = chunk.to_record_batch().schema.names
                components = (name for name in names if ":" in name)
                found.setdefault(str(chunk.entity_path), {}).update(dict.fromkeys(components))
        return {path: tuple(sorted(found[path])) for path in sorted(found)}

    def table(self, entity: str, component: str = "") -> LogTable:
        """One component over time.

        Args:
            entity: path, see `entities`.
            component: by default the only one that changes.

        Raises:
            UsageError: there is no such entity or component, or a component must be named.
        """
        once: dict[str, Any] = {}
        times: dict[str, list[Array]] = {}
        rows: dict[str, list[Any]] = {}
        for file, end in zip(self._files, self._ends(), strict=True):
            for chunk in _chunks(file, entity):
                batch = chunk.to_record_batch()
                for name in batch.schema.names:
                    if ":" not in name:
                        continue
                    values = rows_of(batch.column(name))
                    if chunk.is_static:
                        once[name] = values[-1]
                        continue
                    moments = _times(batch)
                    times.setdefault(name, []).append(moments[moments < end])
                    rows.setdefault(name, []).extend(
                        row for row, at in zip(values, moments, strict=True) if at < end
                    )
        if not once and not rows:
            raise UsageError(
                f"the log has no entity {entity!r}{suggestion(entity, list(self.entities()))}"
            )
        component = component or _only(entity, tuple(rows) or tuple(once))
        names = tuple(map(str, once.get(NAMES, ())))
        if component in rows:
            time = np.concatenate(times[component])
            order = np.argsort(time, kind="stable")
            sorted_rows = tuple(rows[component][k] for k in order.tolist())
            return LogTable(entity, component, time[order], sorted_rows, names)
        if component not in once:
            known = sorted({*once, *rows})
            raise UsageError(f"{entity} has no component {component!r}, but {', '.join(known)}")
        return LogTable(entity, component, np.array([-np.inf]), (once[component],), names)

    def _ends(self) -> list[float]:
        """Time at which each part gives way to the next [s]."""
        return [*(_start(file) for file in self._files[1:]), np.inf]


def read_log(run: Run | str | Path) -> Log:
    """The log of a run.

    Rerun's decoder aborts the process at some damages, so another process reads the log first.

    Args:
        run: the run, its folder, or a folder whose newest run is meant.

    Raises:
        UsageError: there is no such run, it has no log, or the log is damaged.
    """
    files = (run if isinstance(run, Run) else open_run(run)).log_files
    for file in files:
        script = f"from {__name__} import decode; import sys; decode(sys.argv[1])"
        words = [sys.executable, "-P", "-c", script, str(file)]
        if subprocess.run(words, capture_output=True, check=False).returncode < 0:
            raise _damaged(file, "it cannot be decoded")
    return Log(files)


def decode(file: str) -> None:
    """Read everything in a file.

    Raises:
        UsageError: it is no log, or damaged.
    """
    for chunk in _chunks(Path(file)):
        batch = chunk.to_record_batch()
        for name in batch.schema.names:
            if ":" in name:
                rows_of(batch.column(name))


def rows_of(column: pa.Array) -> list[Any]:
    """A column of lists as one array per row; see `LogTable.rows`."""
    values, shape = column.flatten(), []
    while pa.types.is_fixed_size_list(values.type):
        shape.append(values.type.list_size)
        values = values.flatten()
    ends = np.cumsum(column.value_lengths().fill_null(0).to_numpy(zero_copy_only=False))
    if pa.types.is_list(values.type):
        instances = rows_of(values)
        starts = [0, *ends.tolist()]
        return [instances[start:end] for start, end in pairwise(starts)]
    if pa.types.is_nested(values.type):
        return [[np.array(instance) for instance in row or ()] for row in column.to_pylist()]
    flat = values.to_numpy(zero_copy_only=False).reshape(-1, *shape)
    return np.split(flat, ends[:-1])


def _only(entity: str, components: tuple[str, ...]) -> str:
    if len(components) > 1:
        raise UsageError(f"{entity}: name one of its components: {', '.join(sorted(components))}")
    return components[0]


def _times(batch: pa.RecordBatch) -> Array:
    """Times of the rows (n,) [s]."""
    nanoseconds = batch.column(TIMELINE).cast(pa.int64()).to_numpy(zero_copy_only=False)
    times: Array = NANOSECOND * nanoseconds
    return times


def _start(file: Path) -> float:
    """Earliest time in a file [s]."""
    batches = (chunk.to_record_batch() for chunk in _chunks(file) if not chunk.is_static)
    return min((float(_times(b).min()) for b in batches if b.num_rows), default=np.inf)


def _chunks(file: Path, entity: str | None = None) -> Iterator[Any]:
    """Chunks of a file.

    Raises:
        UsageError: it is no log, or ends in the middle of a message, as on a full disk.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that of a killed run has no footer
        try:
            for chunk in RrdReader(str(file)).stream():
                path = str(chunk.entity_path)
                wanted = not path.startswith("/__") if entity is None else path == entity
                if wanted and (chunk.is_static or TIMELINE in chunk.timeline_names):
                    yield chunk
        except (RuntimeError, OSError, ValueError) as error:
            raise _damaged(file, error) from None


def _damaged(file: Path, why: object) -> UsageError:
    return UsageError(
        f"cannot read the log {file}: {why}"
        f"\n  what is whole:  rerun rrd optimize --continue-on-error {file} -o NEW.rrd"
    )
