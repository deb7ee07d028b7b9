import json
import shutil
import struct
import zlib

import pytest

from hsr8.cli.main import entry
from hsr8.recorder.run.run_reader import open_run
from hsr8.robots.locate import find_description

RUN = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--duration", "2"]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A run with camera latency."""
    out = tmp_path_factory.mktemp("runs")
    entry([*RUN, "--no-log", "--quiet", "--set", "camera.latency_ms=60", "--out", str(out)])
    return open_run(out).path


@pytest.fixture
def run(recorded, tmp_path):
    return shutil.copytree(recorded, tmp_path / "run")


def payloads(content):
    """Offset and payload of every frame of a file of measurements."""
    offset = 8
    while offset < len(content):
        length, _ = struct.unpack_from("<II", content, offset)
        yield offset, content[offset + 8 : offset + 8 + length]
        offset += 8 + length


def rewrite(run, index, change):
    """Change a frame's payload and make its checksum right again."""
    file = run / "measurements.bin"
    content = bytearray(file.read_bytes())
    offset, payload = list(payloads(content))[index]
    payload = bytes(change(bytearray(payload)))
    struct.pack_into("<II", content, offset, len(payload), zlib.crc32(payload))
    content[offset + 8 : offset + 8 + len(payload)] = payload
    file.write_bytes(content)


def flipped(index):
    def change(payload):
        payload[index] ^= 1
        return payload

    return change


def stages(capsys):
    """Return the stages of the JSON output by name."""
    return {s["stage"]: s for s in json.loads(capsys.readouterr().out)["stages"]}


def test_a_run_is_recomputed_bit_for_bit(run, capsys):
    assert entry(["verify", str(run)]) == 0
    assert capsys.readouterr().out.count("bit for bit") == 3
    assert entry(["verify", str(run), "--json"]) == 0
    result = stages(capsys)
    assert {name: (s["equal"], s["count"]) for name, s in result.items()} == {
        "physics": (True, 401),
        "estimator": (True, 33),
        "decisions": (True, 33),
    }


@pytest.mark.parametrize(("byte", "channel"), [(-40, "pose"), (-24, "tracks"), (-16, "local map")])
def test_the_first_frame_and_channel_that_differ_are_named(run, capsys, byte, channel):
    rewrite(run, 20, flipped(byte))
    assert entry(["verify", str(run)]) == 1
    assert f": {channel} of frame 20 (1.200 s)" in capsys.readouterr().out


def test_a_changed_measurement_is_found(run, capsys):
    rewrite(run, 7, flipped(8 + 4))  # x of the odometry, in its tenth digit
    assert entry(["verify", str(run), "--json"]) == 1
    first = stages(capsys)["estimator"]
    assert (first["index"], first["channel"]) == (7, "pose")


@pytest.mark.parametrize(
    ("byte", "channel"),
    [(-72, "belief at the decision"), (-64, "task"), (-56, "motion"), (-48, "gaze")],
)
def test_the_decision_that_differs_is_named(run, capsys, byte, channel):
    rewrite(run, 11, flipped(byte))
    assert entry(["verify", str(run), "--json"]) == 1
    result = stages(capsys)
    assert (result["decisions"]["index"], result["decisions"]["channel"]) == (11, channel)
    assert result["physics"]["equal"]
    assert result["estimator"]["equal"]


def test_a_changed_step_count_changes_the_decisions(run, capsys):
    step_count = -(4 + 5) * 8 - 9
    rewrite(run, 12, flipped(step_count))
    assert entry(["verify", str(run), "--json"]) == 1
    assert stages(capsys)["decisions"]["index"] >= 12


def test_a_changed_setpoint_changes_the_world(run, capsys):
    file = run / "tape.bin"
    content = bytearray(file.read_bytes())
    (length, _) = struct.unpack_from("<II", content, 8)
    content[16 + 40 + 8 * 26 * 199 + 6] ^= 1  # of one joint, in the last tick of a second
    struct.pack_into("<II", content, 8, length, zlib.crc32(content[16 : 16 + length]))
    file.write_bytes(content)
    assert entry(["verify", str(run), "--json"]) == 1
    first = stages(capsys)["physics"]
    assert (first["index"], first["channel"]) == (200, "world")


def test_a_changed_scenario_changes_the_belief(run, capsys):
    with (run / "scenario.toml").open("a") as scenario:
        scenario.write("\n[constants.belief.localization]\ndrift = 0.0004\n")
    assert entry(["verify", str(run)]) == 1
    assert "of frame 1" in capsys.readouterr().out


def offset_of(content, index):
    return list(payloads(content))[index][0]


@pytest.mark.parametrize(
    ("name", "damage", "expected"),
    [
        (
            "measurements.bin",
            lambda c: c[: (n := offset_of(c, 5) + 99)] + b"?" + c[n + 1 :],
            "frame 5",
        ),
        ("measurements.bin", lambda c: c[: offset_of(c, 9) + 20], "cut off in frame 9"),
        ("measurements.bin", lambda c: c[: offset_of(c, 9) + 3], "cut off in frame 9"),
        ("measurements.bin", lambda c: c[:8], "cut off, it holds 0 of"),
        ("measurements.bin", lambda c: b"something else", "not a file of measurements"),
        ("measurements.bin", None, "cannot read the file of measurements"),
        ("tape.bin", lambda c: c[:1000] + b"?" + c[1001:], "damaged in block 0"),
        ("tape.bin", lambda c: c[:-1], "cut off in block"),
        ("tape.bin", lambda c: b"HSR8TAP9" + c[8:], "tape of format 9, hsr8"),
        ("tape.bin", None, "cannot read the tape"),
    ],
)
def test_damaged_cut_and_missing_files_are_one_error(run, capsys, name, damage, expected):
    file = run / name
    content = file.read_bytes()
    file.unlink()
    if damage:
        file.write_bytes(damage(content))
    assert entry(["verify", str(run)]) == 2
    printed = capsys.readouterr()
    assert expected in printed.err
    assert printed.err.count("\n") == 1
    assert printed.out.splitlines() == [f"run         {run}"]


def test_a_killed_run_is_checked_as_far_as_it_got(run, capsys):
    file, manifest = run / "measurements.bin", run / "manifest.json"
    content = file.read_bytes()
    file.write_bytes(content[:-5])
    manifest.write_text(manifest.read_text().replace('"timeout"', '"running"'))
    assert entry(["verify", str(run), "--json"]) == 0
    assert stages(capsys)["estimator"]["count"] == 32
    file.write_bytes(content[:8])
    assert entry(["verify", str(run), "--json"]) == 0
    assert stages(capsys)["physics"]["count"] == 401


def test_a_robot_file_is_found_from_every_folder(tmp_path, monkeypatch, capsys):
    """A change of it is named where the run is different."""
    file = tmp_path / "mine.toml"
    shutil.copy(find_description("hsr8"), file)
    file.write_text(file.read_text().replace("radius = 0.12", "radius = 0.13"))
    monkeypatch.chdir(tmp_path)
    assert entry([*RUN, "--robot", "mine.toml", "--no-log", "--quiet"]) == 1
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert entry(["verify", "../runs/quick"]) == 0
    file.write_text(file.read_text().replace("l_elbow_pitch = -0.9", "l_elbow_pitch = -0.8"))
    capsys.readouterr()
    assert entry(["verify", "../runs/quick"]) == 1
    assert "robot mine was " in capsys.readouterr().out
