"""CSV files of a run: every number of the tables is in them, bit for bit, with its unit."""

import csv

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.recording.rows import TABLES
from hsr8.recording.table import Items


@pytest.fixture(scope="module")
def folder(run, tmp_path_factory):
    path = tmp_path_factory.mktemp("exports") / "csv"
    assert entry(["export", str(run.path), "--csv", str(path)]) == 0
    return path


def read(file):
    """Return the columns of a file as text."""
    with file.open(newline="") as lines:
        head, *rows = csv.reader(lines)
    columns = zip(*rows, strict=True) if rows else ([] for _ in head)
    return dict(zip(head, columns, strict=True))


def check(table, columns, times):
    left = list(columns.items())
    if times is not None:
        assert np.array_equal(np.array(left.pop(0)[1], float), times)
    for name in table:
        values = table[name]
        if not isinstance(values, np.ndarray):
            continue
        count = int(np.prod(values.shape[1:]))
        some, left = left[:count], left[count:]
        assert all(key == name or key.startswith(f"{name}_") for key, _ in some)
        if values.dtype == float:
            written = np.array([[float(v or "nan") for v in column] for _, column in some])
            expected = values.reshape(len(values), count).T
            assert np.array_equal(written.reshape(expected.shape), expected, equal_nan=True), name
    assert not left


@pytest.mark.parametrize("name", TABLES)
def test_numbers_are_those_of_the_table(name, run, folder):
    table = getattr(run, name)
    check(table, read(folder / f"{name}.csv"), None)
    for column in table:
        if isinstance(table[column], Items):
            items = table[column]
            times = table["time"][items.parents]
            check(items, read(folder / f"{name}.{column}.csv"), times)


def test_lists_and_maps_of_a_row_have_their_own_file(run, folder):
    support = read(folder / "records.support.csv")
    assert np.array_equal(
        np.transpose([np.array(support[f"support_{k}"], float) for k in range(2)]),
        np.concatenate(run.records["support"]),
    )
    local_map = read(folder / "frames.local_map.csv")
    rows, maps = run.frames.present("local_map")
    assert np.array_equal(np.array(local_map.pop("time"), float), run.frames["time"][rows])
    shades = np.array([*local_map.values()], int).T
    assert np.array_equal(shades.reshape(maps.shape), maps)


def test_joints_have_names_and_columns_units(run, folder):
    joints = run.ticks.names("joint_position")
    head = read(folder / "ticks.csv")
    assert {f"joint_position_{name}" for name in joints} <= head.keys()
    lines = read(folder / "columns.csv")
    known = dict(zip(zip(lines["file"], lines["column"], strict=True), lines["unit"], strict=True))
    assert known["ticks.csv", "joint_position"] == "rad"
    assert known["frames.tracks.csv", "position"] == "m"
    counts = dict.fromkeys(lines["file"], 0)
    for file, elements in zip(lines["file"], lines["elements"], strict=True):
        counts[file] += int(elements)
    assert counts == {file: len(read(folder / file)) for file in counts}
