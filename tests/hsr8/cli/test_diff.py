import json
import re
import shutil
import struct
import zlib

import pytest

from hsr8.cli.main import entry
from hsr8.recorder.run.run_reader import open_run

RUN = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--duration", "2"]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Two runs that differ by a fault after 1 s."""
    out = tmp_path_factory.mktemp("runs")
    black = 'fault=[{kind="camera-black",start=1.0,duration=0.5}]'
    for name, more in (("a", []), ("b", ["--set", black])):
        entry([*RUN, "--no-log", "--quiet", "--out", str(out / name), *more])
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


def test_the_first_difference_is_where_the_setting_acts(recorded, capsys):
    code, result = diff(capsys, *recorded)
    assert code == 1
    first = result["first"]
    assert (first["record"], first["channel"], first["tick"]) == ("events", "kind of event 0", 200)
    assert (first["a"], first["b"]) == (None, "fault")
    first = next(d for d in result["differences"] if d["record"] == "measurements")
    assert 1.0 <= first["time"] < 1.1
    assert first["tick"] == round(first["time"] / 0.005)
    assert "number of observations" in first["channel"]
    assert first["a"] > first["b"] == 0
    keys = {d["channel"] for d in result["differences"] if d["record"] == "settings"}
    assert keys == {f"fault.0.{key}" for key in ("kind", "start", "duration")}


def test_the_order_of_the_runs_only_swaps_the_values(recorded, capsys):
    (_, one), (_, other) = diff(capsys, *recorded), diff(capsys, *reversed(recorded))
    assert one["first"] | {"a": 0, "b": 0} == other["first"] | {"a": 0, "b": 0}
    assert (one["first"]["a"], one["first"]["b"]) == (other["first"]["b"], other["first"]["a"])


def test_one_changed_bit_of_a_setpoint_is_found_with_tick_and_joint(recorded, tmp_path, capsys):
    copy = shutil.copytree(recorded[0], tmp_path / "copy")
    file = copy / "tape.bin"
    content = bytearray(file.read_bytes())
    (length, _) = struct.unpack_from("<II", content, 8)
    content[16 + 40 + 8 * (26 * 77 + 3)] ^= 1
    struct.pack_into("<II", content, 8, length, zlib.crc32(content[16 : 16 + length]))
    file.write_bytes(content)
    code, result = diff(capsys, recorded[0], copy)
    assert code == 1
    assert result["first"]["tick"] == 77
    assert re.fullmatch(r"setpoint of [lr]_\w+ \[rad\]", result["first"]["channel"])
    assert result["first"]["a"] != result["first"]["b"]


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


@pytest.mark.parametrize(
    ("name", "record", "channel"),
    [
        ("trajectory.bin", "trajectory", "number of rows"),
        ("walking.bin", "walking", "number of rows"),
        ("frames.jsonl", "frames", "number of frames"),
        ("measurements.bin", "measurements", "number of frames"),
    ],
)
def test_a_shorter_record_differs(recorded, tmp_path, capsys, name, record, channel):
    copy = _killed(recorded[0], tmp_path / "copy")
    content = (copy / name).read_bytes()
    (copy / name).write_bytes(content[: len(content) // 2])
    code, result = diff(capsys, recorded[0], copy)
    assert code == 1
    (first,) = [d for d in result["differences"] if d["record"] in (record, "tape")]
    assert (first["record"], first["channel"]) == (record, channel)
    assert first["a"] > first["b"] > 0
    assert first["time"] == pytest.approx(1.0, abs=0.2)


@pytest.mark.parametrize("name", ["trajectory.bin", "walking.bin", "frames.jsonl", "tape.bin"])
def test_a_cut_record_of_an_ended_run_is_refused(recorded, tmp_path, capsys, name):
    copy = shutil.copytree(recorded[0], tmp_path / "copy")
    content = (copy / name).read_bytes()
    (copy / name).write_bytes(content[: len(content) // 2])
    assert entry(["diff", str(recorded[0]), str(copy)]) == 2
    assert f"{name}" in (message := capsys.readouterr().err)
    assert "cut off" in message
    assert entry(["verify", str(copy)]) == 2
    assert "cut off" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["frames.jsonl", "events.jsonl"])
def test_a_damaged_line_is_a_usage_error(recorded, tmp_path, capsys, name):
    copy = shutil.copytree(recorded[0], tmp_path / "copy")
    (copy / name).write_text("garbage\n")
    assert entry(["diff", str(recorded[0]), str(copy)]) == 2
    assert f"{name}:1: the line is damaged" in capsys.readouterr().err


def test_values_of_walking_and_events_are_compared(recorded, tmp_path, capsys):
    copy = shutil.copytree(recorded[0], tmp_path / "copy")
    content = bytearray((copy / "walking.bin").read_bytes())
    content[-1] ^= 1
    (copy / "walking.bin").write_bytes(content)
    with (copy / "events.jsonl").open("a") as events:
        events.write('{"time": 1.5, "kind": "collision", "text": "made up"}\n')
    code, result = diff(capsys, recorded[0], copy)
    assert code == 1
    first = {d["record"]: d for d in result["differences"]}
    assert first.keys() == {"walking", "events"}
    assert first["walking"]["channel"].startswith("torque_")
    assert (first["events"]["channel"], first["events"]["tick"]) == ("kind of event 0", 300)
