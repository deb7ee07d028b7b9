"""Tables of a run as CSV files.

Each element of an array is a column, such as ``zmp_0`` or ``joint_position_l_knee``. Objects, lists
and maps of a row are rows of a separate file, with the time of the row. The file `COLUMNS` has
the unit and the description of every column; all elements of an array have one line there.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc
from numpy.typing import NDArray

from hsr8.recording.columns import shape_of
from hsr8.recording.rows import TABLES
from hsr8.recording.run import Run
from hsr8.recording.table import Items, Table

COLUMNS = "columns.csv"
IMAGES = "images"  # folder


@dataclass
class _Sheet:
    """Columns of a file.

    Attributes:
        name: name of the file, without suffix.
        columns: values by name (n,).
        about: lines of `COLUMNS`.
    """

    name: str
    columns: dict[str, Any] = field(default_factory=dict)
    about: list[dict[str, Any]] = field(default_factory=list)

    def add_times(self, times: NDArray[np.float64]) -> None:
        """Add the times of the rows (n,) [s]."""
        self.columns["time"] = pa.array(times)
        self._describe("time", 1, "s", "time of the row")

    def add(self, name: str, values: Any, table: Table, column: str) -> None:
        """Add a column of a table, or one for each element of its arrays (n, ...)."""
        labels = [name]
        if isinstance(values, np.ndarray) and values.ndim > 1:
            first, *rest = values.shape[1:]
            names = table.names(column)
            heads = names if len(names) == first else tuple(map(str, range(first)))
            labels = ["_".join([name, *map(str, at)]) for at in product(heads, *map(range, rest))]
            values = values.reshape(len(values), len(labels)).T
        else:
            values = [_texts(values)]
        for label, value in zip(labels, values, strict=True):
            self.columns[label] = pa.array(value)
        self._describe(name, len(labels), table.unit(column), table.description(column))

    def _describe(self, name: str, count: int, unit: str, text: str) -> None:
        line = {"file": f"{self.name}.csv", "column": name, "elements": count}
        self.about.append({**line, "unit": unit, "description": text})


def write_csv(run: Run, folder: Path) -> int:
    """Write the tables of a run as CSV files and return their number.

    Args:
        run: run of any length.
        folder: new.

    Raises:
        UsageError: a table cannot be read.
        OSError: the folder cannot be written.
    """
    folder.mkdir()
    about: list[dict[str, Any]] = []
    for name in TABLES:
        table = getattr(run, name)
        for sheet in _sheets(name, table, None):
            if "jpeg" in sheet.columns:
                sheet.columns["jpeg"] = _write_images(folder, table)
            pc.write_csv(pa.table(sheet.columns), folder / f"{sheet.name}.csv")
            about += sheet.about
    pc.write_csv(pa.Table.from_pylist(about), folder / COLUMNS)
    return len({line["file"] for line in about})


def _sheets(name: str, table: Table, times: NDArray[np.float64] | None) -> Iterator[_Sheet]:
    """Yield the files of a table: its own and those of its nested columns.

    Args:
        name: name of the file.
        table: the table.
        times: times of its rows [s]; None for a table with a column of times.
    """
    own = _Sheet(name)
    if times is None:
        times = table["time"]
    else:
        own.add_times(times)
    for column in table:
        values, nested = table[column], f"{name}.{column}"
        if isinstance(values, Items):
            yield from _sheets(nested, values, times[values.parents])
        elif not isinstance(values, list):
            own.add(column, values, table, column)
        else:
            shape = shape_of(table.arrow.schema.field(column))
            optional = pa.types.is_primitive(table.arrow.schema.field(column).type.value_type)
            if optional and shape:
                rows, some = table.present(column)
                if not len(rows):
                    continue
            else:
                rows = np.repeat(np.arange(len(values)), [len(value) for value in values])
                some = np.concatenate(values) if values else np.zeros((0, *shape))
            sheet = _Sheet(nested)
            sheet.add_times(times[rows])
            sheet.add(column, some, table, column)
            yield sheet
    yield own


def _texts(values: Any) -> Any:
    """Return bytes as hexadecimal digits, other values as they are."""
    if any(isinstance(value, bytes) for value in values[:1]):
        return [value.hex() if value else None for value in values]
    return values


def _write_images(folder: Path, images: Table) -> pa.Array:
    """Write the images and return the names of their files."""
    (folder / IMAGES).mkdir()
    names = [f"{IMAGES}/{index:06d}.jpg" for index in images["index"].tolist()]
    for name, content in zip(names, images["jpeg"], strict=True):
        (folder / name).write_bytes(content)
    return pa.array(names, pa.string())
