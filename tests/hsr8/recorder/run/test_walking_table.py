from dataclasses import replace
from math import pi

import numpy as np
import pytest

from hsr8.errors import UsageError
from hsr8.recorder.run.walking_table import (
    COLUMNS,
    MAGIC,
    OdometryToWorld,
    WalkingTableWriter,
    read_walking_table,
)
from hsr8.robots.loaded import load_robot
from hsr8.world.truth.truth import ActivePush
from walking.body.odometry import Odometry
from walking.command import VelocityCommand
from walking.command_limits import CommandLimits, Limit


@pytest.fixture
def written(tmp_path, model, walk):
    """A walk of one second, its file, and its records."""
    path, records = tmp_path / "walking.bin", list(walk(1.0))
    writer = WalkingTableWriter(path, load_robot("hsr8").model)
    for record in records:
        writer.on_record(record)
    writer.close("goal")
    return path, records


def test_a_written_table_is_read_back(written):
    path, records = written
    table = read_walking_table(path)
    assert table.time.tolist() == [r.time for r in records]
    names = load_robot("hsr8").model.names
    assert list(table.columns) == [*COLUMNS, *(f"torque_{name}" for name in names[:12])]
    assert list(table.torque_limit) == list(names[:12])
    assert table["robot_x"] == pytest.approx([r.truth.robot[0] for r in records])
    assert table["applied_vx"] == pytest.approx([0.2] * len(records))
    assert table["left_y"] == pytest.approx([0.042] * len(records))
    assert table["left_force"] == pytest.approx([17.0] * len(records))
    assert table.sole == pytest.approx((0.01, 0.0525, 0.03))
    assert table.torque_limit["l_knee"] == 6.0


def test_an_unknown_column_is_answered_with_the_known_ones(written):
    table = read_walking_table(written[0])
    for ask in (lambda: table["zmp"], lambda: table.points("zpm")):
        with pytest.raises(KeyError, match=r"no column 'z.*zmp_x, zmp_y"):
            ask()


def test_a_cut_file_loses_its_last_row(written):
    path, records = written
    path.write_bytes(path.read_bytes()[:-5])
    assert len(read_walking_table(path)) == len(records) - 1


@pytest.mark.parametrize(
    ("column", "value"),
    [("time", np.nan), ("roll", np.inf), ("phase", np.nan), ("phase", 99.0), ("limits", -np.inf)],
)
def test_an_impossible_row_is_refused(written, column, value):
    path, records = written
    rows = np.dtype([("time", "<f8"), ("values", "<f4", (len(COLUMNS) + 12,))])
    content = path.read_bytes()
    start = len(content) - len(records) * rows.itemsize
    table = np.frombuffer(content[start:], rows).copy()
    if column == "time":
        table["time"][7] = value
    else:
        table["values"][7, COLUMNS.index(column)] = value
    path.write_bytes(content[:start] + table.tobytes())
    with pytest.raises(UsageError, match="damaged in row 7"):
        read_walking_table(path)


def test_a_window_holds_both_ends(written):
    table = read_walking_table(written[0]).window(0.2, 0.4)
    assert table.time[[0, -1]].tolist() == pytest.approx([0.2, 0.4])
    assert len(table["phase"]) == len(table) == 11


def test_constraints_and_pushes_have_columns(tmp_path, model, fake):
    asked = VelocityCommand(0.5)
    report = CommandLimits(asked, asked, (Limit.SPEED, Limit.BALANCE, Limit.SPEED))
    push = ActivePush(
        0, 0.0, 0.05, "torso_link", 0.0, np.array([0.1, 0.2, 0.3]), np.array([1.0, -2.0, 0.0])
    )
    records = [fake.record(0.0), fake.record(0.02, pushes=(push,))]
    records[1] = replace(records[1], walking=replace(records[1].walking, command_limits=report))
    writer = WalkingTableWriter(tmp_path / "w.bin", load_robot("hsr8").model)
    for record in records:
        writer.on_record(record)
    writer.close("goal")
    table = read_walking_table(tmp_path / "w.bin")
    assert {k: v.tolist() for k, v in table.active_limits().items()} == {
        Limit.SPEED: [False, True],
        Limit.BALANCE: [False, True],
    }
    assert table["push_fy"].tolist() == [0.0, -2.0]
    assert table["push_z"] == pytest.approx([0.0, 0.3])


def test_odometry_is_transformed_with_the_true_pose(fake):
    record = fake.record(0.0, (1.0, 2.0, pi / 2))
    walking = replace(record.walking, odometry=Odometry(0.5, 0.0, 0.0, np.eye(3)))
    transform = OdometryToWorld([replace(record, walking=walking), fake.record(0.02)])
    assert transform.turn.tolist() == [pi / 2, 0.0]
    points = np.array([[[0.5, 0.0], [0.6, 0.0]], [[0.5, 0.0], [0.6, 0.0]]])
    transformed = transform.point(points)
    assert transformed[0] == pytest.approx(np.array([[1.0, 2.0], [1.0, 2.1]]))
    assert transformed[1] == pytest.approx(points[1])
    assert transform.point(points[0], np.array([0, 0])) == pytest.approx(transformed[0])
    assert transform.vector(np.array([[1.0, 0.0]] * 2)) == pytest.approx(np.array([[0, 1], [1, 0]]))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "cannot read the walking table"),
        (b"HSR8TRJ1", "not a walking table"),
        (MAGIC + b"x" * 8, "incomplete header"),
    ],
)
def test_a_missing_or_another_file_is_refused(tmp_path, content, message):
    path = tmp_path / "walking.bin"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(UsageError, match=message):
        read_walking_table(path)


def test_a_damaged_header_is_refused(written):
    path, _ = written
    content = path.read_bytes()
    for damaged in (
        content[:200],
        content.replace(b'"zmp_depth"', b'"zmp_deepn"'),
        content.replace(b'"knee": [3]', b'"knee": [9]'),
        content.replace(b'"l_knee"', b'"l_nose"', 1),
    ):
        assert damaged != content
        path.write_bytes(damaged)
        with pytest.raises(UsageError, match="incomplete header"):
            read_walking_table(path)
