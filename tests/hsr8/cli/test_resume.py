"""A run that was killed goes on from its checkpoint, to the identical end."""

import json
import shutil
import subprocess
import sys

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.evaluation.run_difference import motion, results
from hsr8.recorder.files import atomic
from hsr8.recorder.log.log_reader import Log
from hsr8.recorder.run.run_reader import open_run

STAND_INS = ["--body", "kinematic", "--camera", "analytic"]
QUICK = [
    "run",
    "quick",
    "--seed",
    "6",
    "--duration",
    "5",
    "--quiet",
    "--set",
    "camera.latency_ms=60",
]
KILLED = """
import os, sys
from hsr8.cli.main import entry
from hsr8.loop import Simulation
step, tick = Simulation.step, int(sys.argv[1])
def until(self):
    if self.tick == tick:
        os._exit(9)
    return step(self)
Simulation.step = until
entry(sys.argv[2:])
"""


def killed(out, tick, *more):
    """A run that dies without a word before control tick `tick`."""
    words = [*QUICK, *more, "--checkpoint", "every=1", "--out", str(out)]
    command = [sys.executable, "-c", KILLED, str(tick), *words]
    assert subprocess.run(command, check=False, timeout=100).returncode == 9
    return open_run(out)


def check_the_same(run, whole):
    assert motion(run, whole) == []
    assert list(results(run, whole)) == []
    for name in ("trajectory.bin", "walking.bin", "measurements.bin", "tape.bin", "frames.jsonl"):
        assert (run.path / name).read_bytes() == (whole.path / name).read_bytes()
    assert run.events() == whole.events()


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    out = tmp_path_factory.mktemp("whole")
    entry([*QUICK, *STAND_INS, "--no-log", "--out", str(out)])
    return open_run(out)


@pytest.fixture(scope="module")
def cut_short(tmp_path_factory):
    """Killed at 3.085 s, its last checkpoint at 3 s."""
    return killed(tmp_path_factory.mktemp("cut"), 617, *STAND_INS, "--no-log")


@pytest.fixture
def cut(cut_short, tmp_path):
    return open_run(shutil.copytree(cut_short.path, tmp_path / "run"))


def test_a_killed_run_comes_to_the_identical_end(cut, whole, capsys):
    assert cut.manifest["exit_reason"] == "running"
    assert entry(["run", str(cut.path), "--resume", "--quiet"]) == 1  # no goal in 5 s
    check_the_same(open_run(cut.path), whole)
    assert cut.log_files == []
    assert entry(["check", "replay", str(cut.path)]) == 0


@pytest.mark.gl
def test_physics_pixels_and_log_go_on_too(tmp_path):
    words = [word for word in QUICK if word != "5"]
    words.insert(words.index("--duration") + 1, "2.5")
    entry([*words, "--no-log", "--out", str(tmp_path / "whole")])
    run = killed(tmp_path / "cut", 403, "--duration", "2.5", "--log-level", "full")
    assert entry(["run", str(run.path), "--resume", "--quiet"]) == 1
    run = open_run(run.path)
    check_the_same(run, open_run(tmp_path / "whole"))
    assert [file.name for file in run.log_files] == ["log.rrd", "log-2.rrd"]
    times = Log(run.log_files).table("/plots/tilt").time
    assert np.diff(times).max() == pytest.approx(0.02)  # every pose, without a hole
    assert (run.manifest["log"], run.manifest["checkpoint"]) == ("full", 1)


def test_a_run_that_ended_has_nothing_to_go_on_with(whole, capsys):
    assert entry(["run", str(whole.path), "--resume"]) == 2
    assert "ended by 'timeout'" in capsys.readouterr().err


def test_without_a_checkpoint_there_is_nothing_to_go_on_from(cut, capsys):
    (cut.path / "checkpoint.bin").unlink()
    assert entry(["run", str(cut.path), "--resume"]) == 2
    assert "no checkpoint" in capsys.readouterr().err


@pytest.mark.parametrize(
    "option", [["--seed", "3"], ["--duration", "9"], ["--set", "seed=1"], ["--out", "elsewhere"]]
)
def test_a_run_goes_on_as_what_it_was(cut, option, capsys):
    assert entry(["run", str(cut.path), "--resume", *option]) == 2
    assert f"{option[0]} cannot be given with --resume" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "value"), [("log", "most"), ("log", ["full"]), ("checkpoint", -1), ("checkpoint", "2")]
)
def test_a_manifest_that_does_not_say_how_to_record_is_told(cut, name, value, capsys):
    atomic.write_json(cut.path / "manifest.json", cut.manifest | {name: value})
    assert entry(["run", str(cut.path), "--resume"]) == 2
    assert f"the manifest of {cut.path} names no" in capsys.readouterr().err


def test_a_run_without_a_log_is_shown_only_with_a_level_for_it(cut, capsys):
    assert entry(["run", str(cut.path), "--resume", "--view", "web"]) == 2
    assert "give --log-level" in capsys.readouterr().err


def test_a_damaged_checkpoint_is_reported_and_leaves_the_run_as_it_was(cut, capsys):
    file = cut.path / "checkpoint.bin"
    content = file.read_bytes()
    before = {f.name: f.read_bytes() for f in cut.path.iterdir()} | {}
    for wrong, text in (
        (content[:1000], "is cut off"),
        (content[:5000] + b"?" + content[5001:], "is damaged"),
        (b"something else", "is no snapshot"),
        (b"HSR8SNP1" + content[8:], "is a snapshot of format 1, hsr8"),
    ):
        file.write_bytes(wrong)
        assert entry(["run", str(cut.path), "--resume"]) == 2
        assert text in capsys.readouterr().err
    del before[file.name]
    assert before == {f.name: f.read_bytes() for f in cut.path.iterdir() if f != file}


def test_another_scenario_is_not_mixed_in(cut, capsys):
    scenario = cut.scenario_file
    scenario.write_text(scenario.read_text().replace("duration = 5.0", "duration = 6.0"))
    assert entry(["run", str(cut.path), "--resume"]) == 2
    assert "is another one than at the checkpoint" in capsys.readouterr().err


def test_a_file_that_lost_its_end_is_found_out(cut, capsys):
    file = cut.path / "tape.bin"
    file.write_bytes(file.read_bytes()[:500])
    assert entry(["run", str(cut.path), "--resume"]) == 2
    assert "is shorter than at the checkpoint" in capsys.readouterr().err


def test_an_empty_file_that_is_gone_is_made_again(cut, whole, capsys):
    file = cut.path / "events.jsonl"
    assert not file.read_bytes()  # what is missing of it is nothing
    file.unlink()
    assert entry(["run", str(cut.path), "--resume", "--quiet"]) == 1
    check_the_same(open_run(cut.path), whole)


def test_checkpoints_change_nothing(whole, tmp_path, capsys):
    entry([*QUICK, *STAND_INS, "--no-log", "--checkpoint", "2", "--out", str(tmp_path)])
    check_the_same(open_run(tmp_path), whole)


@pytest.mark.parametrize("period", ["-1", "0", "every=0", "every=1.5", "every", "every=1s", ""])
def test_a_period_is_whole_seconds(tmp_path, capsys, period):
    expected = 0 if not period else 2
    words = ["run", "quick", "--checkpoint", period, "--dry-run", "--out", str(tmp_path)]
    assert entry(words) == expected
    assert ("whole simulated seconds" in capsys.readouterr().err) == (expected == 2)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["events.jsonl", "frames.jsonl"])
def test_lines_that_were_damaged_before_the_checkpoint_are_not_gone_on_with(tmp_path, name, capsys):
    fault = 'fault=[{kind="camera-black",start=0.5,duration=0.2}]'
    cut = killed(tmp_path, 210, *STAND_INS, "--no-log", "--set", fault)
    file = cut.path / name
    file.write_bytes(b"garbage\n" + b"x" * file.stat().st_size)
    before = {f.name: f.read_bytes() for f in cut.path.iterdir()}
    assert entry(["run", str(cut.path), "--resume"]) == 2
    assert f"{file}:1: the line is" in capsys.readouterr().err
    assert before == {f.name: f.read_bytes() for f in cut.path.iterdir()}


def test_a_folder_that_may_not_be_written_is_a_usage_error(cut, monkeypatch, capsys):
    monkeypatch.setattr("os.access", lambda path, mode: False)
    assert entry(["run", str(cut.path), "--resume"]) == 2
    assert "it may only be read" in capsys.readouterr().err


def test_a_run_that_went_on_can_be_verified(cut, capsys):
    assert entry(["run", str(cut.path), "--resume", "--verify-determinism", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["deterministic"] is True
