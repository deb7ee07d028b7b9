"""Reading of the Rerun log of a run into arrays, also of a run that was killed."""

import warnings
from collections.abc import Iterator
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
        time: of each row (n,) [s]; -inf for a static component, logged once.
        rows: n arrays, one element per instance; lists of arrays if the instances differ in
            length, as those of lines do.
        names: names of the curves of a plot; empty for other entities.
    """

    entity: str
    component: str
    time: Array
    rows: tuple[Any, ...]
    names: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.time)

    def array(self) -> NDArray[Any]:
        """Return all rows in one array (n, instances, ...).

        Raises:
            ValueError: the rows have different numbers of instances.
        """
        shapes = {np.shape(row) for row in self.rows}
        if len(shapes) > 1:
            raise ValueError(f"{self.entity}: the rows have different lengths; read them in rows")
        return np.array(self.rows)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return one curve of a plot (n,).

        Raises:
            KeyError: unknown curve.
        """
        if name not in self.names:
            raise KeyError(
                f"{self.entity}: no curve {name!r}; expected one of {', '.join(self.names)}"
            )
        curve: NDArray[Any] = self.array()[:, self.names.index(name)]
        return curve


class Log:
    """The Rerun log of a run.

    Args:
        file: the log.
    """

    def __init__(self, file: Path) -> None:
        self._file = file

    def entities(self) -> dict[str, tuple[str, ...]]:
        """Return the components of every entity, by its path.

        Raises:
            UsageError: the log is damaged.
        """
        components: dict[str, set[str]] = {}
        for chunk in self._chunks():
            names = chunk.to_record_batch().schema.names
            entity = components.setdefault(str(chunk.entity_path), set())
            entity.update(name for name in names if ":" in name)
        return {path: tuple(sorted(components[path])) for path in sorted(components)}

    def table(self, entity: str, component: str = "") -> LogTable:
        """Return one component over time.

        Args:
            entity: path, see `entities`.
            component: by default the only one that changes.

        Raises:
            UsageError: unknown or ambiguous entity or component, or the log is damaged.
        """
        static: dict[str, Any] = {}
        times: dict[str, list[Array]] = {}
        rows: dict[str, list[Any]] = {}
        for chunk in self._chunks(entity):
            batch = chunk.to_record_batch()
            for name in batch.schema.names:
                if ":" not in name:
                    continue
                values = rows_of(batch.column(name))
                if chunk.is_static:
                    static[name] = values[-1]
                else:
                    times.setdefault(name, []).append(_times(batch))
                    rows.setdefault(name, []).extend(values)
        if not static and not rows:
            raise UsageError(
                f"{self._file}: no entity {entity!r}{suggestion(entity, list(self.entities()))}"
            )
        component = component or _only(entity, tuple(rows) or tuple(static))
        names = tuple(map(str, static.get(NAMES, ())))
        if component in rows:
            time = np.concatenate(times[component])
            order = np.argsort(time, kind="stable")
            sorted_rows = tuple(rows[component][k] for k in order.tolist())
            return LogTable(entity, component, time[order], sorted_rows, names)
        if component not in static:
            known = ", ".join(sorted({*static, *rows}))
            raise UsageError(f"{entity}: no component {component!r}; expected one of {known}")
        return LogTable(entity, component, np.array([-np.inf]), (static[component],), names)

    def _chunks(self, entity: str | None = None) -> Iterator[Any]:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the log of a killed run has no footer
            try:
                for chunk in RrdReader(str(self._file)).stream():
                    path = str(chunk.entity_path)
                    wanted = not path.startswith("/__") if entity is None else path == entity
                    if wanted and (chunk.is_static or TIMELINE in chunk.timeline_names):
                        yield chunk
            except (RuntimeError, OSError, ValueError) as error:
                raise UsageError(
                    f"cannot read the log {self._file}: {error}"
                    "\n  to recover its complete parts:  rerun rrd optimize --continue-on-error "
                    f"{self._file} -o NEW.rrd"
                ) from None


def read_log(run: Run | str | Path) -> Log:
    """Return the log of a run.

    Args:
        run: the run, its folder, or a folder whose newest run is meant.

    Raises:
        UsageError: there is no such run, or it has no log.
    """
    opened = run if isinstance(run, Run) else open_run(run)
    if opened.log_file is None:
        raise UsageError(f"{opened.path}: no log, the run was made with --no-log")
    return Log(opened.log_file)


def rows_of(column: pa.Array) -> list[Any]:
    """Return a column of lists as one array per row; see `LogTable.rows`."""
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
        raise UsageError(
            f"{entity}: several components; expected one of {', '.join(sorted(components))}"
        )
    return components[0]


def _times(batch: pa.RecordBatch) -> Array:
    """Return the times of the rows (n,) [s]."""
    nanoseconds = batch.column(TIMELINE).cast(pa.int64()).to_numpy(zero_copy_only=False)
    times: Array = NANOSECOND * nanoseconds
    return times
