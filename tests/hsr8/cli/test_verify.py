import json
import re
import shutil

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.errors import SimulationDiverged
from hsr8.recording.run import open_run
from hsr8.robots.file.locate import find_description
from hsr8.world.body.kinematic import KinematicBody

RUN = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--duration", "2"]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A run with camera latency."""
    out = tmp_path_factory.mktemp("runs")
    entry([*RUN, "--quiet", "--set", "camera.latency_ms=60", "--out", str(out)])
    return open_run(out).path


@pytest.fixture
def run(recorded, tmp_path):
    return shutil.copytree(recorded, tmp_path / "run")


def flipped(value):
    """Return a value, or nested values with the first one, slightly changed."""
    if isinstance(value, list):
        return [flipped(value[0]), *value[1:]]
    if isinstance(value, bytes):
        return bytes([value[0] ^ 1]) + value[1:]
    return value + 1e-9 if isinstance(value, float) else value + 1


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


def test_the_first_frame_and_column_that_differ_are_named(run, rewrite, capsys):
    rewrite(run, "frames", "pose", 20, flipped)
    assert entry(["verify", str(run)]) == 1
    assert ": pose[0] [m, m, rad] of frame 20 (1.260 s)" in capsys.readouterr().out


def test_another_arithmetic_is_named_before_the_stages(run, rewrite, capsys):
    rewrite(run, "frames", "pose", 20, flipped)
    file = run / "manifest.json"
    manifest = json.loads(file.read_text())
    now = manifest["libraries"]["arithmetic"]
    manifest["libraries"]["arithmetic"] = "another"
    file.write_text(json.dumps(manifest))
    assert entry(["verify", str(run)]) == 1
    _, first, *_ = capsys.readouterr().out.splitlines()
    assert first == f"changed     arithmetic was another, is {now}: the last bits differ"
    assert entry(["verify", str(run), "--json"]) == 1
    changed = json.loads(capsys.readouterr().out)["changed"]
    assert changed == {"arithmetic": {"then": "another", "now": now}}


@pytest.mark.parametrize(
    ("column", "stage"),
    [
        ("motion_covariance", "estimator"),
        ("pose", "estimator"),
        ("velocity", "decisions"),
        ("psi", "decisions"),
    ],
)
def test_a_changed_value_is_found(run, rewrite, capsys, column, stage):
    rewrite(run, "frames", column, 7, flipped)
    assert entry(["verify", str(run), "--json"]) == 1
    result = stages(capsys)
    assert result[stage]["index"] == 7
    assert not result[stage]["equal"]
    assert result["physics"]["equal"]


def test_a_change_of_the_whole_local_map_is_found(run, rewrite, capsys):
    rewrite(run, "frames", "map_hash", 17, flipped)
    assert entry(["verify", str(run), "--json"]) == 1
    assert stages(capsys)["estimator"]["channel"] == "map_hash"


@pytest.mark.parametrize("key", ["distance", "covariance"])
def test_a_changed_detection_is_found(run, rewrite, capsys, key):
    def change(detections):
        return [detection | {key: flipped(detection[key])} for detection in detections]

    counts = open_run(run).frames["detections"].counts
    row = int(np.nonzero(counts)[0][-3])
    rewrite(run, "frames", "detections", row, change)
    assert entry(["verify", str(run), "--json"]) == 1
    assert stages(capsys)["estimator"]["index"] in (row, row + 1)


def test_a_changed_step_count_changes_the_decisions(run, rewrite, capsys):
    rewrite(run, "frames", "step_count", 12, flipped)
    assert entry(["verify", str(run), "--json"]) == 1
    assert stages(capsys)["decisions"]["index"] >= 12


def test_frames_in_another_order_are_found(run, rewrite, capsys):
    rewrite(run, "frames", "captured", 9, lambda time: time - 0.1)
    assert entry(["verify", str(run), "--json"]) == 1
    first = stages(capsys)["estimator"]
    assert (first["index"], first["channel"]) == (9, "order")


@pytest.mark.parametrize(
    ("table", "column", "row", "tick"),
    [("ticks", "setpoint", 199, 200), ("seconds", "world", 1, 200), ("seconds", "tick", 1, 201)],
)
def test_a_changed_setpoint_or_hash_is_found(run, rewrite, capsys, table, column, row, tick):
    rewrite(run, table, column, row, flipped)
    assert entry(["verify", str(run), "--json"]) == 1
    first = stages(capsys)["physics"]
    assert (first["index"], first["channel"]) == (tick, "world")


def test_a_changed_scenario_changes_the_belief(run, capsys):
    file = run / "scenario.toml"
    text, changes = re.subn(r"(?m)^drift = .*$", "drift = 0.0004", file.read_text())
    assert changes == 1
    file.write_text(text)
    assert entry(["verify", str(run)]) == 1
    assert "of frame 1" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "damage", "expected"),
    [
        ("frames.arrows", lambda c: c[:-20], "cut off or damaged, got "),
        ("frames.arrows", None, "cut off or damaged, got 0 rows; expected 33"),
        ("ticks.arrows", lambda c: b"text" + c, "cut off or damaged, got 0 rows"),
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


def test_a_killed_run_is_checked_up_to_its_last_batch(run, capsys):
    manifest = run / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"timeout"', '"running"'))
    for name in ("frames", "ticks"):
        file = run / f"{name}.arrows"
        file.write_bytes(file.read_bytes()[:-1000])
    assert entry(["verify", str(run), "--json"]) == 0
    result = stages(capsys)
    assert result["physics"]["count"] == 200 * (result["physics"]["count"] // 200) > 0
    assert 0 < result["estimator"]["count"] < 33
    (run / "frames.arrows").write_bytes(b"")
    assert entry(["verify", str(run), "--json"]) == 0
    assert stages(capsys)["estimator"]["count"] == 0


def test_a_robot_file_is_found_from_every_folder(tmp_path, monkeypatch, capsys):
    """A change of it is named where the run is different."""
    file = tmp_path / "mine.toml"
    shutil.copy(find_description("hsr8"), file)
    file.write_text(file.read_text().replace("radius = 0.12", "radius = 0.13"))
    monkeypatch.chdir(tmp_path)
    assert entry([*RUN, "--robot", "mine.toml", "--quiet"]) == 1
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert entry(["verify", "../runs/quick"]) == 0
    file.write_text(file.read_text().replace("l_elbow_pitch = -0.9", "l_elbow_pitch = -0.8"))
    capsys.readouterr()
    assert entry(["verify", "../runs/quick"]) == 1
    assert "robot mine was " in capsys.readouterr().out


def test_a_diverged_run_diverges_again_at_the_same_tick(tmp_path, monkeypatch, rewrite, capsys):
    apply = KinematicBody.apply

    def diverging(self, targets):
        if self.time > 1.3:
            raise SimulationDiverged("the physics diverged")
        apply(self, targets)

    monkeypatch.setattr(KinematicBody, "apply", diverging)
    assert entry([*RUN, "--quiet", "--out", str(tmp_path)]) == 3
    run = open_run(tmp_path)
    assert entry(["verify", str(run.path), "--json"]) == 0
    assert stages(capsys)["physics"]["count"] == len(run.ticks)
    rewrite(run.path, "seconds", "world", len(run.seconds) - 1, flipped)
    assert entry(["verify", str(run.path)]) == 1


def test_physics_that_diverges_only_in_the_replay_is_different(run, monkeypatch, capsys):
    def diverging(self, targets):
        raise SimulationDiverged("the physics diverged")

    monkeypatch.setattr(KinematicBody, "apply", diverging)
    assert entry(["verify", str(run), "--json"]) == 1
    first = stages(capsys)["physics"]
    assert (first["index"], first["channel"]) == (0, "the physics diverged")
