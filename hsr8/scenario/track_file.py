"""CSV files of recorded tracks: reading, checks of the rows, samples of each track.

The columns are t [s], x [m], y [m] and id. Commas, semicolons and tabs separate them; between
semicolons, numbers may have decimal commas. A scenario holds them as text, see `content`.
"""

import csv
import hashlib
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit
from numpy.typing import NDArray

from hsr8.files.text import read_text
from hsr8.mistakes import Mistake
from hsr8.scenario.world import TrackMover

COLUMNS = ("t", "x", "y", "id")
SEPARATORS = ",;\t"
MAX_ROWS = 50_000
MAX_ID = 32  # [characters]
MAX_GAP = 1.0  # between the samples of a track [s]
MAX_TIME = 1e10  # [s]
MAX_COORDINATE = 1e5  # [m]

Array = NDArray[np.float64]
Table = dict[str, Any]


class TrackFileError(Exception):
    """Invalid track file; the message has the line, the wrong value and the expected one."""


@dataclass(frozen=True, slots=True, eq=False)
class RecordedTrack:
    """Samples of one id.

    Attributes:
        id: name in the file.
        times: times of the samples (n,) [s].
        points: positions at the samples (n, 2) [m].
    """

    id: str
    times: Array
    points: Array


def track_movers(tables: Mapping[str, Any]) -> Iterator[tuple[int, Table]]:
    """Yield the tables of recorded movers in the tables of a scenario, and their indices."""
    world = tables.get("world")
    movers = world.get("mover") if isinstance(world, dict) else None
    for i, mover in enumerate(movers if isinstance(movers, list) else ()):
        if (
            isinstance(mover, dict)
            and mover.get("motion") == "track"
            and isinstance(mover.get("file"), str)
        ):
            yield i, mover


def read_tracks(tables: Table) -> list[Mistake]:
    """Put the content of track files into their movers; return the invalid files.

    The content replaces the file: its name alone is kept.
    """
    problems, read = list[Mistake](), dict[int, Table]()
    for i, mover in track_movers(tables):
        name, data = Path(mover["file"]).name, mover.get("data")
        try:
            text = data if isinstance(data, str) and data else _read(mover["file"])
            read[i] = {**mover, "file": name, "data": content(text)}
        except TrackFileError as error:
            problems.append(Mistake(("world", "mover", i, "file"), f"{name}, {error}"))
    if read:
        movers = [read.get(i, mover) for i, mover in enumerate(tables["world"]["mover"])]
        tables["world"] = {**tables["world"], "mover": movers}
    return problems


def legible(tables: Table) -> Table:
    """Return the tables of a scenario for TOML, with one line for each row of its recordings."""
    movers = [
        {**m, "data": tomlkit.string(m["data"], literal=True, multiline=True)} if "data" in m else m
        for m in tables["world"]["mover"]
    ]
    return {**tables, "world": {**tables["world"], "mover": movers}}


def _read(file: str) -> str:
    try:
        return read_text(file)
    except FileNotFoundError:
        raise TrackFileError(
            f"file does not exist, got {file!r}; expected a CSV file next to the scenario or in "
            "the working folder"
        ) from None
    except OSError as error:
        raise TrackFileError(
            f"cannot be read, got {file!r}: {error.strerror}; expected a CSV file"
        ) from None


def content(text: str) -> str:
    """Return the four columns of a CSV text as CSV, without other columns and empty lines.

    Raises:
        TrackFileError: a column is missing, or a row is invalid.
    """
    rows = _rows(text)
    lines = [",".join(COLUMNS), *(",".join(fields) for _, fields in rows)]
    _check_tracks(rows)
    return "\n".join(lines) + "\n"


@lru_cache(maxsize=16)
def recorded_tracks(data: str) -> tuple[RecordedTrack, ...]:
    """Return the tracks of a `content`, in the order of their first rows."""
    samples: dict[str, list[tuple[float, ...]]] = {}
    for line in data.splitlines()[1:]:
        t, x, y, name = line.split(",")
        samples.setdefault(name, []).append((float(t), float(x), float(y)))
    tables = ((name, np.array(rows)) for name, rows in samples.items())
    return tuple(RecordedTrack(name, table[:, 0], table[:, 1:]) for name, table in tables)


def track_digests(movers: Iterable[object]) -> dict[str, str]:
    """Return the first 12 digits of the SHA-256 of each recording's `content`, by file name."""
    return {
        f"tracks {mover.file}": hashlib.sha256(mover.data.encode()).hexdigest()[:12]
        for mover in movers
        if isinstance(mover, TrackMover)
    }


Row = tuple[int, tuple[str, ...]]
"""Number of the line, and the fields of the four columns."""


def _rows(text: str) -> list[Row]:
    """Return the rows with valid fields."""
    lines = text.splitlines()
    separator, header = _header(lines[0] if lines else "")
    reader = csv.reader(lines, delimiter=separator)
    order = [header.index(name) for name in COLUMNS]
    try:
        next(reader)
        rows = [
            (reader.line_num, _fields(reader.line_num, row, order, separator))
            for row in reader
            if row
        ]
    except csv.Error as error:
        raise TrackFileError(f"line {reader.line_num}: not CSV: {error}") from None
    if not 1 <= len(rows) <= MAX_ROWS:
        raise TrackFileError(f"got {len(rows)} rows; expected 1 to {MAX_ROWS}")
    return rows


def _header(line: str) -> tuple[str, list[str]]:
    """Return the separator that the first line has most often, and its names in lower case."""
    separator = max(SEPARATORS, key=line.count)
    try:
        (names,) = csv.reader([line], delimiter=separator)
    except (csv.Error, ValueError):
        names = []
    header = [name.strip().lower() for name in names]
    for name in COLUMNS:
        if header.count(name) != 1:
            problem = "missing" if name not in header else "repeated"
            raise TrackFileError(
                f"line 1: column {name!r} is {problem}, got {line[:60]!r}; expected a header with "
                "t, x, y and id, separated by commas, semicolons or tabs"
            )
    return separator, header


def _fields(line: int, row: list[str], order: list[int], separator: str) -> tuple[str, ...]:
    if len(row) <= max(order):
        raise TrackFileError(
            f"line {line}: a column is missing, got {len(row)} values; expected t, x, y and id"
        )
    *numbers, name = (row[k].strip() for k in order)
    if separator == ";":
        numbers = [number.replace(",", ".") for number in numbers]
    for column, number in zip(COLUMNS, numbers, strict=False):
        limit = MAX_TIME if column == "t" else MAX_COORDINATE
        try:
            valid = "_" not in number and abs(float(number)) <= limit
        except ValueError:
            valid = False
        if not valid:
            unit = "seconds" if column == "t" else "metres"
            raise TrackFileError(
                f"line {line}: {column} is not valid, got {number[:60]!r}; "
                f"expected {unit} from {-limit:g} to {limit:g}"
            )
    if not (0 < len(name) <= MAX_ID and all(c.isalnum() or c in "._-" for c in name)):
        raise TrackFileError(
            f"line {line}: id is not valid, got {name[:60]!r}; "
            f"expected 1 to {MAX_ID} letters, digits, '.', '_' or '-'"
        )
    return *numbers, name


def _check_tracks(rows: list[Row]) -> None:
    """Check the times of each track."""
    tracks: dict[str, list[tuple[int, float]]] = {}
    for line, (t, _, _, name) in rows:
        tracks.setdefault(name, []).append((line, float(t)))
    problems = [problem for name, samples in tracks.items() for problem in _gaps(name, samples)]
    if problems:
        line, text = min(problems)
        raise TrackFileError(f"line {line}, {text}")


def _gaps(name: str, samples: list[tuple[int, float]]) -> Iterator[tuple[int, str]]:
    """Yield line and text of every wrong time of a track."""
    if len(samples) == 1:
        line, t = samples[0]
        yield line, f"id {name}: only one sample, got t = {t:g} s; expected at least 2"
    for (_, before), (line, t) in pairwise(samples):
        if t == before:
            yield (
                line,
                f"id {name}: duplicate sample, got t = {t:g} s twice; "
                "expected one row for each time and id",
            )
        elif t < before:
            yield (
                line,
                f"id {name}: time decreases, got t = {t:g} s after {before:g} s; "
                "expected increasing times within an id",
            )
        elif not math.isclose(t - before, MAX_GAP) and t - before > MAX_GAP:
            yield (
                line,
                f"id {name}: gap between samples, got {t - before:g} s after t = {before:g} s; "
                f"expected at most {MAX_GAP:g} s, or another id after the gap",
            )
