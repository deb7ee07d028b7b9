import json
import os

import pytest

from hsr8.errors import UsageError
from hsr8.recording import run_folder
from hsr8.recording.manifest import FORMAT, Manifest
from hsr8.recording.run import open_run
from hsr8.recording.run_folder import RunFolder
from hsr8.scenario.loader import load_scenario


@pytest.fixture
def folder(tmp_path):
    path = RunFolder.create(tmp_path, "quick", 7)
    words = ("hsr8", "run", "quick", "--seed", "7")
    return RunFolder(path, load_scenario("quick", seed=7), words, "analytic")


def test_folders_of_equal_runs_are_different(tmp_path):
    paths = {RunFolder.create(tmp_path, "quick", 7) for _ in range(20)}
    assert len(paths) == 20
    assert all(p.parent == tmp_path / "quick" and p.name.startswith("7-") for p in paths)


def test_a_finished_run_can_be_read_back(folder):
    folder.end("goal", rows={"ticks": 5})
    folder.write_metrics({"success": True, "time_to_goal_s": float("nan")})
    run = open_run(folder.path)
    assert run.seed == 7
    assert run.manifest["exit_reason"] == "goal"
    assert run.manifest["rows"] == {"ticks": 5}
    assert run.manifest["libraries"]["mujoco"].startswith("4.0")
    assert run.metrics == {"success": True, "time_to_goal_s": None}
    assert run.scenario() == load_scenario("quick", seed=7)


def test_the_newest_run_below_a_folder_is_meant(tmp_path):
    for age, seed in ((300, 1), (100, 2), (200, 3)):
        path = RunFolder.create(tmp_path, "quick", seed)
        file = path / run_folder.MANIFEST
        Manifest.now(load_scenario("quick", seed=seed), (), "analytic").write(file)
        os.utime(file, (1e9 - age, 1e9 - age))
    assert open_run(tmp_path).seed == 2
    assert open_run(tmp_path / "quick").seed == 2


def test_runs_are_looked_for_at_the_two_levels_of_scenario_and_run_only(tmp_path):
    path = RunFolder.create(tmp_path / "runs", "quick", 1)
    RunFolder(path, load_scenario("quick"), (), "analytic")
    for folder in (path, path.parent, tmp_path / "runs"):
        assert open_run(folder).path == path
    with pytest.raises(UsageError, match="no run in this folder"):
        open_run(tmp_path)


def test_a_missing_run_is_a_usage_error_with_alternatives(tmp_path):
    path = RunFolder.create(tmp_path, "quick", 1)
    with pytest.raises(UsageError, match="no run in this folder"):
        open_run(path)
    with pytest.raises(UsageError, match=path.name):
        open_run(tmp_path / "quick" / "1-abc")


def test_a_broken_manifest_is_a_usage_error(tmp_path):
    for text in ("{", json.dumps([1]), "{}", json.dumps({"seed": "one"})):
        (tmp_path / run_folder.MANIFEST).write_text(text)
        with pytest.raises(UsageError, match="cannot read"):
            open_run(tmp_path)


@pytest.mark.parametrize(
    ("number", "message"),
    [
        (None, f"run folder of format 1, .* reads format {FORMAT}: run the scenario again"),
        (FORMAT + 1, f"run folder of format {FORMAT + 1}, .* reads format {FORMAT}"),
        ("two", "format: expected an integer"),
    ],
)
def test_a_folder_of_another_format_is_refused_by_its_number(folder, number, message):
    file = folder.path / run_folder.MANIFEST
    manifest = json.loads(file.read_text())
    assert manifest.pop("format") == FORMAT
    file.write_text(json.dumps(manifest | ({"format": number} if number else {})))
    with pytest.raises(UsageError, match=message):
        open_run(folder.path)


def test_a_folder_that_cannot_be_created_is_a_usage_error(tmp_path):
    (tmp_path / "runs").write_text("a file, not a folder")
    with pytest.raises(UsageError, match="--out"):
        RunFolder.create(tmp_path / "runs", "quick", 1)
