import json
import subprocess
import tempfile

import pytest

from hsr8.cli import verify as module
from hsr8.cli.main import entry
from hsr8.cli.verify import verify
from hsr8.errors import Hsr8Error
from hsr8.recorder.run.run_reader import open_run

FAST = [
    "run",
    "quick",
    "--body",
    "kinematic",
    "--camera",
    "analytic",
    "--duration",
    "1",
    "--no-log",
]


def test_another_process_makes_the_same_run(tmp_path, capsys):
    assert entry([*FAST, "--out", str(tmp_path), "--verify-determinism", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["deterministic"] is True


def test_a_run_that_cannot_be_repeated_is_found_out(tmp_path, capsys):
    """The folder says another seed than the one it was made with."""
    entry([*FAST, "--out", str(tmp_path), "--quiet"])
    run = open_run(tmp_path)
    text = run.scenario_file.read_text()
    assert "seed = 2\n" in text
    run.scenario_file.write_text(text.replace("seed = 2\n", "seed = 3\n"))
    verified = verify(run.path)
    assert not verified.equal
    assert "tick 0" in verified.difference
    assert verified.second.is_dir()


@pytest.mark.parametrize("stopped", [Hsr8Error, KeyboardInterrupt])
def test_a_second_run_that_comes_to_no_end_leaves_nothing(tmp_path, monkeypatch, stopped):
    def second(*_, **__):
        if stopped is KeyboardInterrupt:
            raise KeyboardInterrupt
        return subprocess.CompletedProcess([], 3, "", "no memory")

    entry([*FAST, "--out", str(tmp_path / "runs"), "--quiet"])
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(module.subprocess, "run", second)
    with pytest.raises(stopped):
        verify(open_run(tmp_path / "runs").path)
    assert [path.name for path in tmp_path.iterdir()] == ["runs"]


def test_a_difference_fails_the_run(tmp_path, monkeypatch, capsys):
    found = module.Verified("tick 7 (0.035 s), set-point", 3, tmp_path)
    monkeypatch.setattr("hsr8.cli.recorded_run.verify", lambda folder: found)
    settings = ["--set", "criteria.goal_reached=false"]
    assert entry([*FAST, "--out", str(tmp_path), *settings, "--verify-determinism"]) == 1
    assert "tick 7" in capsys.readouterr().out
