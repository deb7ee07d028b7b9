import json

import pytest

from hsr8.cli.main import entry
from hsr8.recorder.run.run_reader import open_run


@pytest.fixture
def run(tmp_path, capsys):
    """A run of a second."""
    fast = ["--body", "kinematic", "--camera", "analytic", "--duration", "1", "--no-log"]
    entry(["run", "quick", *fast, "--quiet", "--out", str(tmp_path)])
    capsys.readouterr()
    return open_run(tmp_path)


def test_json_holds_what_the_folder_holds(run, capsys):
    assert entry(["info", str(run.path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["manifest"] == run.manifest
    assert told["metrics"] == run.metrics()
    assert told["files"] == {f.name: f.stat().st_size for f in run.path.iterdir()}
    assert {c["name"]: c["met"] for c in told["criteria"]} == {
        "falls": True,
        "goal reached": False,
    }


def test_people_read_how_it_ended_and_how_to_repeat_it(run, capsys):
    assert entry(["info", str(run.path)]) == 0
    told = capsys.readouterr().out
    assert "timeout" in told
    assert run.manifest["command"] in told


def test_another_version_is_told(run, capsys):
    manifest = json.loads((run.path / "manifest.json").read_text())
    manifest["libraries"]["mujoco"] = "0.0.1"
    (run.path / "manifest.json").write_text(json.dumps(manifest))
    entry(["info", str(run.path)])
    assert "was 0.0.1" in capsys.readouterr().out


def test_a_killed_run_and_one_of_another_version_are_no_obstacle(run, capsys):
    manifest = json.loads((run.path / "manifest.json").read_text()) | {"exit_reason": "running"}
    (run.path / "manifest.json").write_text(json.dumps(manifest))
    (run.path / "scenario.toml").write_text("what = 1\n")
    assert entry(["info", str(run.path)]) == 0
    assert "running, or killed" in capsys.readouterr().out
    (run.path / "metrics.json").unlink()
    assert entry(["info", str(run.path)]) == 0
