import json
import re
import shutil

import pytest

from hsr8.cli.main import entry
from hsr8.recording.rows import TABLES
from hsr8.recording.run import open_run

RUN = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--duration", "2"]
RUN += ["--set", "navigation.gaze.mode=fixed"]  # detections in every frame


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Two runs that differ by a fault after 1 s."""
    out = tmp_path_factory.mktemp("runs")
    black = 'fault=[{kind="camera-black",start=1.0,duration=0.5}]'
    for name, more in (("a", []), ("b", ["--set", black])):
        entry([*RUN, "--quiet", "--out", str(out / name), *more])
    return open_run(out / "a").path, open_run(out / "b").path


def diff(capsys, a, b):
    code = entry(["diff", str(a), str(b), "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_a_run_does_not_differ_from_its_copy(recorded, tmp_path, capsys):
    copy = shutil.copytree(recorded[0], tmp_path / "copy")
    code, result = diff(capsys, recorded[0], copy)
    assert (code, result["equal"], result["first"], result["differences"]) == (0, True, None, [])
    assert entry(["diff", str(recorded[0]), str(copy)]) == 0
    assert "bit for bit" in capsys.readouterr().out


@pytest.mark.gl
def test_runs_that_keep_other_images_are_equal(tmp_path, capsys):
    words = ["run", "quick", "--body", "kinematic", "--duration", "0.3", "--quiet", "--out"]
    for kept in ("none", "full"):
        entry([*words, str(tmp_path / kept), "--set", f"recorder.images={kept}"])
    code, result = diff(capsys, tmp_path / "none", tmp_path / "full")
    assert (code, result["equal"]) == (0, True)
    assert {d["record"] for d in result["differences"]} == {"settings"}


def test_the_first_difference_is_where_the_setting_acts(recorded, capsys):
    code, result = diff(capsys, *recorded)
    assert code == 1
    first = result["first"]
    assert (first["record"], first["channel"], first["tick"]) == ("events", "number of rows", 200)
    assert (first["a"], first["b"]) == (0, 2)
    first = next(d for d in result["differences"] if d["record"] == "frames")
    assert 1.0 <= first["time"] < 1.1
    assert first["tick"] == round(first["time"] / 0.005)
    assert first["channel"] == "number of detections"
    assert first["a"] > first["b"] == 0
    keys = {d["channel"] for d in result["differences"] if d["record"] == "settings"}
    assert keys == {f"fault.0.{key}" for key in ("kind", "start", "duration")}


def test_the_order_of_the_runs_only_swaps_the_values(recorded, capsys):
    (_, one), (_, other) = diff(capsys, *recorded), diff(capsys, *reversed(recorded))
    assert one["first"] | {"a": 0, "b": 0} == other["first"] | {"a": 0, "b": 0}
    assert (one["first"]["a"], one["first"]["b"]) == (other["first"]["b"], other["first"]["a"])


@pytest.mark.parametrize(
    ("table", "column", "row", "change", "channel"),
    [
        ("ticks", "setpoint", 77, lambda v: [*v[:3], v[3] + 1e-15, *v[4:]], "setpoint of joint"),
        ("ticks", "down", 77, lambda v: not v, "down"),
        ("records", "odometry_covariance", 9, lambda v: [*v[:5], 1.0, *v[6:]], "[1, 2] [m, rad]"),
        ("records", "phase", 9, lambda _: "flying", "phase"),
        ("records", "support", 9, lambda v: [[v[0][0], -0.5], *v[1:]], "support[0, 1] [m]"),
        ("records", "support", 9, lambda v: v[1:], "shape of support"),
        ("records", "footsteps", 9, lambda v: v[:-1], "number of footsteps"),
        ("frames", "tracks", 20, lambda v: [v[0] | {"age": -1.0}, *v[1:]], "tracks[0].age [s]"),
        ("frames", "body_direction", 20, lambda _: 1.0, "body_direction [rad]"),
        ("frames", "local_map", 17, lambda v: [v[0] ^ 1, *v[1:]], "local_map[0, 0]"),
        ("seconds", "robot", 1, lambda v: b"?" + v[1:], "robot"),
    ],
)
def test_one_changed_value_is_found(
    recorded, rewrite, tmp_path, capsys, table, column, row, change, channel
):
    copy = shutil.copytree(recorded[0], tmp_path / "copy")
    rewrite(copy, table, column, row, change)
    code, result = diff(capsys, recorded[0], copy)
    assert code == 1
    (first,) = (d for d in result["differences"] if d["record"] != "results")
    time = float(getattr(open_run(copy), table)["time"][row])
    assert (first["record"], first["tick"], first["time"]) == (table, round(time / 0.005), time)
    joint = open_run(copy).ticks.names("setpoint")[3]
    assert channel.replace("joint", joint) in first["channel"]
    assert first["a"] != first["b"]


def test_the_wall_clock_is_not_compared(recorded, rewrite, tmp_path, capsys):
    copy = shutil.copytree(recorded[0], tmp_path / "copy")
    rewrite(copy, "ticks", "walking_time", 5, lambda _: 1.0)
    assert diff(capsys, recorded[0], copy)[0] == 0


def test_a_signed_zero_differs_and_nan_does_not(recorded, rewrite, tmp_path, capsys):
    runs = [shutil.copytree(recorded[0], tmp_path / name) for name in ("a", "b")]
    for run in runs:
        rewrite(run, "records", "cop", 5, lambda _: [float("nan"), float("nan")])
    assert diff(capsys, *runs)[0] == 0
    for run, zero in zip(runs, (0.0, -0.0), strict=True):
        rewrite(run, "records", "cop", 6, lambda _, zero=zero: [zero, 1.0])
    assert diff(capsys, *runs)[1]["first"]["channel"] == "cop[0] [m]"


def test_the_first_difference_is_printed_in_one_line(recorded, capsys):
    assert entry(["diff", *map(str, recorded)]) == 1
    out = capsys.readouterr().out
    assert re.search(r"differ      at tick \d+ \(\d\.\d{3} s\)", out)
    assert "settings" in out


def _killed(run, to):
    """Copy a run and mark it as killed."""
    copy = shutil.copytree(run, to)
    file = copy / "manifest.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {"exit_reason": "running"}))
    return copy


@pytest.mark.parametrize("name", ["ticks", "records", "frames"])
def test_a_shorter_table_differs(recorded, tmp_path, capsys, name):
    copy = _killed(recorded[0], tmp_path / "copy")
    file = copy / f"{name}.arrows"
    content = file.read_bytes()
    file.write_bytes(content[: len(content) * 2 // 3])
    code, result = diff(capsys, recorded[0], copy)
    assert code == 1
    (first,) = (d for d in result["differences"] if d["record"] != "results")
    assert (first["record"], first["channel"]) == (name, "number of rows")
    assert first["a"] > first["b"] > 0
    assert first["time"] == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("name", sorted(TABLES.keys() - {"images", "commands"}))
def test_a_cut_or_missing_table_of_an_ended_run_is_refused(recorded, tmp_path, capsys, name):
    copy = shutil.copytree(recorded[1], tmp_path / "copy")
    file = copy / f"{name}.arrows"
    content = file.read_bytes()
    file.write_bytes(content[: len(content) // 2])
    for command in (["diff", str(recorded[0]), str(copy)], ["verify", str(copy)]):
        assert entry(command) == 2
        message = capsys.readouterr().err
        assert f"{name}.arrows: cut off or damaged" in message
        assert message.count("\n") == 1
    file.unlink()
    assert entry(["diff", str(recorded[0]), str(copy)]) == 2
    assert f"{name}.arrows: cut off or damaged, got 0 rows; " in capsys.readouterr().err
