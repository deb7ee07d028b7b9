"""Tables of a run: rows out are rows in, at any cut a readable rest."""

import resource
from contextlib import suppress
from dataclasses import dataclass, fields
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from hsr8.errors import RecordingFailed, UsageError
from hsr8.recording.columns import (
    BYTES,
    INT,
    SHADE,
    TEXT,
    Column,
    Row,
    attributes,
    batch_of,
    schema_of,
)
from hsr8.recording.rows import TABLES
from hsr8.recording.stream import ArrowFiles, read_table
from hsr8.recording.table import Table

Array = NDArray[np.float64]
TICKS = st.lists(st.integers(0, 200), min_size=1, max_size=20, unique=True).map(sorted)


@dataclass
class Part:
    name: str
    place: Array


@dataclass
class Thing:
    time: float
    count: int
    angle: Array
    outline: Array
    parts: tuple[Part, ...]
    labels: tuple[str, ...]
    guess: float | None
    image: NDArray[np.uint8] | None
    state: bytes
    pair: Any


def read(file):
    with file.open("rb") as content:
        return read_table("things", content, THING)


PART = Row(
    "Part of a thing.",
    Column("name", "name of the part", type=TEXT),
    Column("place", "place of the part", "m", (2,)),
)
THING = Row(
    "Thing.",
    Column("time", "simulated time", "s"),
    Column("count", "number of things", type=INT),
    Column("angle", "angles of the joints", "rad", ("joints",)),
    Column("outline", "outline of something", "m", ("n", 2)),
    Column("parts", "parts of something", items=PART),
    Column("labels", "labels of something", shape=("n",), type=TEXT),
    Column("guess", "guess, which may be missing", "m", optional=True),
    Column("image", "shades", "1", ("rows", "columns"), SHADE, optional=True),
    Column("state", "content", type=BYTES),
    Column(("pair.left", "pair.right"), "left and right side", "m", (2,), name="sides"),
    Column("pair.middle.value", "middle, which may be missing", "m", optional=True, name="middle"),
    Column(lambda thing: thing.pair.left + thing.pair.right, "sum of the sides", "m", name="sum"),
)


def rows(n, seed=0):
    rng = np.random.default_rng(seed)
    return [
        Thing(
            time=0.1 * k,
            count=k,
            angle=rng.normal(size=3),
            outline=rng.normal(size=(k % 4, 2)),
            parts=tuple(Part(f"part {i}", rng.normal(size=2)) for i in range(k % 3)),
            labels=("a", "b")[: k % 3],
            guess=None if k % 2 else 0.5 * k,
            image=rng.integers(0, 255, (2, 5)).astype(np.uint8) if k % 3 == 0 else None,
            state=bytes([k % 256]),
            pair=SimpleNamespace(
                left=0.1 * k,
                right=-0.2 * k,
                middle=SimpleNamespace(value=0.3 * k) if k % 2 else None,
            ),
        )
        for k in range(n)
    ]


def write_all(files, content, size=7):
    schema = schema_of(THING, content, {"joints": ("hip", "knee", "ankle")})
    for start in range(0, len(content), size):
        batch = batch_of(THING, content[start : start + size], schema)
        files.add({"things": Table("things", pa.Table.from_batches([batch]))})


def written(folder, content):
    files = ArrowFiles(folder)
    write_all(files, content)
    files.close()
    return folder / "things.arrows"


def check(table, content):
    assert len(table) == len(content)
    if not content:
        return
    assert table["time"].tolist() == [row.time for row in content]
    assert np.array_equal(table["angle"], [row.angle for row in content])
    parts = table["parts"]
    assert parts.counts.tolist() == [len(row.parts) for row in content]
    assert [*parts["name"]] == [part.name for row in content for part in row.parts]
    for k, row in enumerate(content):
        assert np.array_equal(table["outline"][k], row.outline)
        assert tuple(table["labels"][k]) == row.labels
        places = parts.of(k)["place"]
        assert np.array_equal(places, np.reshape([p.place for p in row.parts], (-1, 2)))
        assert (table["image"][k] is None) == (row.image is None)
    chosen, images = table.present("image")
    assert chosen.tolist() == [k for k, row in enumerate(content) if row.image is not None]
    assert np.array_equal(images, [row.image for row in content if row.image is not None])
    assert np.array_equal(np.isnan(table["guess"]), [row.guess is None for row in content])
    assert [*table["state"]] == [row.state for row in content]
    assert [*map(tuple, table["sides"])] == [(row.pair.left, row.pair.right) for row in content]
    middles = [row.pair.middle for row in content]
    chosen, values = table.present("middle")
    assert chosen.tolist() == [k for k, middle in enumerate(middles) if middle is not None]
    assert values.tolist() == [middle.value for middle in middles if middle is not None]
    assert table["sum"].tolist() == [row.pair.left + row.pair.right for row in content]


def test_rows_out_are_rows_in(tmp_path):
    content = rows(30)
    table = read(written(tmp_path, content))
    check(table, content)
    check(table.rows(4, 19), content[4:19])
    check(table.window(0.5, 1.2), content[5:13])
    chosen = [3, 0, 29, 12, 13]
    check(table.take(np.array(chosen)), [content[k] for k in chosen])
    check(table.take(np.array(chosen)).take(np.array([4, 1])), [content[13], content[0]])
    check(table.take(np.array(chosen)).rows(1, 3), [content[0], content[29]])
    assert table.unit("angle") == "rad"
    assert table.names("angle") == ("hip", "knee", "ankle")
    assert table.description("count") == "number of things"
    assert table["parts"].unit("place") == "m"


def test_attributes_are_the_inverse_of_the_columns_at_every_path(tmp_path):
    content = rows(9)
    table = read(written(tmp_path, content))
    things = [*attributes(THING, table)]
    parts = [Part(**part) for part in attributes(PART, table["parts"])]
    assert [part.name for part in parts] == [part.name for row in content for part in row.parts]
    for row, thing in zip(content, things, strict=True):
        assert {*thing} == {field.name for field in fields(Thing)} - {"parts", "pair"}
        assert thing["time"] == row.time
        assert type(thing["count"]) is int
        assert np.array_equal(thing["angle"], row.angle)
        assert np.array_equal(thing["outline"], row.outline)
        assert thing["state"] == row.state
    pairs = [*attributes(THING, table, "pair")]
    assert pairs == [{"left": row.pair.left, "right": row.pair.right} for row in content]


def test_rows_are_objects_of_plain_values(tmp_path):
    content = rows(9)
    table = read(written(tmp_path, content))
    chosen = [8, 1, 5]
    objects = table.take(np.array(chosen)).objects("time", "angle", "parts.name", "guess")
    assert [{*vars(thing)} for thing in objects] == 3 * [{"time", "angle", "parts", "guess"}]
    for thing, k in zip(objects, chosen, strict=True):
        assert (thing.time, thing.angle) == (content[k].time, content[k].angle.tolist())
        assert [vars(part) for part in thing.parts] == [{"name": p.name} for p in content[k].parts]
    (first, *_) = table.objects()
    assert {*vars(first)} == {*table}
    with pytest.raises(UsageError, match="unknown column 'tim'"):
        table.objects("tim")


def test_a_table_cut_off_at_any_byte_keeps_its_whole_batches(tmp_path):
    content = rows(21)
    file = written(tmp_path, content)
    whole, lengths = file.read_bytes(), set()
    for size in (*range(0, len(whole), 97), len(whole) - 1):
        file.write_bytes(whole[:size])
        table = read(file)
        check(table, content[: len(table)])
        lengths.add(len(table))
    assert lengths == {0, 7, 14, 21}


@pytest.mark.parametrize("size", [100, 3000, 7001])
def test_a_full_disk_is_one_error_and_the_whole_batches_stay(tmp_path, size):
    content, files = rows(70), ArrowFiles(tmp_path)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        with pytest.raises(RecordingFailed, match="File too large"):
            write_all(files, content)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    files.close()  # with room again
    table = read(tmp_path / "things.arrows")
    check(table, content[: len(table)])
    assert len(content) > len(table) >= files.rows.get("things", 0)


def test_a_damaged_table_keeps_the_batches_before_the_damage(tmp_path):
    content = rows(21)
    file = written(tmp_path, content)
    whole = file.read_bytes()
    for k in range(0, len(whole), 61):
        file.write_bytes(whole[:k] + bytes([whole[k] ^ 0x5A]) + whole[k + 1 :])
        with suppress(ValueError):  # the damage is in the schema
            assert len(read(file)) in (0, 7, 14, 21)


def test_a_table_of_other_columns_is_refused(tmp_path):
    file = written(tmp_path, rows(3))
    with pytest.raises(ValueError, match="column 'count'"):
        read_table("things", pa.py_buffer(file.read_bytes()), TABLES["ticks"])


def test_an_unknown_column_is_an_error_with_a_suggestion(tmp_path):
    table = read(written(tmp_path, rows(3)))
    with pytest.raises(UsageError, match=r"unknown column 'angel'.*angle"):
        table["angel"]


@given(TICKS, st.integers(-5, 205))
def test_the_row_at_a_time_is_the_last_one_not_after_it(ticks, wanted):
    table = Table("ticks", pa.table({"time": 0.02 * np.array(ticks)}))
    (row,) = table.at([0.02 * wanted]).tolist()
    earlier = [k for k, tick in enumerate(ticks) if tick <= wanted]
    assert row == (earlier[-1] if earlier else 0)


@pytest.mark.parametrize("name", TABLES)
def test_every_column_has_a_description_and_every_quantity_a_unit(name):
    columns = [*TABLES[name].columns]
    for column in columns:  # and those of the objects in columns
        assert column.text
        if str(column.type) == "double":
            assert column.unit, column.name
        columns += () if column.items is None else column.items.columns


@pytest.mark.parametrize("name", TABLES)
def test_a_table_without_rows_has_all_columns(name, tmp_path):
    table = read_table(name, None, TABLES[name])
    assert len(table) == 0
    assert [*table] == [column.name for column in TABLES[name].columns]
    for column in table:
        assert len(table[column]) == 0
