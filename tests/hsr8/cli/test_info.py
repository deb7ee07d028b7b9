import json
import re
from pathlib import Path

import pytest

from hsr8.cli.main import entry


@pytest.fixture
def run(quick_run):
    return quick_run


def test_json_has_all_contents_of_the_folder(run, capsys):
    assert entry(["info", str(run.path), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["manifest"] == run.manifest
    assert result["metrics"] == run.metrics
    assert result["files"] == {f.name: f.stat().st_size for f in run.path.iterdir()}
    assert {c["name"]: c["met"] for c in result["criteria"]} == {
        "falls": True,
        "goal reached": False,
    }


def test_end_and_command_are_printed(run, capsys):
    assert entry(["info", str(run.path)]) == 0
    result = capsys.readouterr().out
    assert "timeout" in result
    assert run.manifest["command"] in result


def test_other_versions_are_printed(run, capsys):
    manifest = json.loads((run.path / "manifest.json").read_text())
    manifest["libraries"]["mujoco"] = "0.0.1"
    (run.path / "manifest.json").write_text(json.dumps(manifest))
    entry(["info", str(run.path)])
    assert "was 0.0.1" in capsys.readouterr().out


def test_killed_runs_and_unreadable_scenarios_are_shown(run, capsys):
    manifest = json.loads((run.path / "manifest.json").read_text()) | {"exit_reason": "running"}
    (run.path / "manifest.json").write_text(json.dumps(manifest))
    (run.path / "scenario.toml").write_text("unknown = 1\n")
    assert entry(["info", str(run.path)]) == 0
    assert "running, or killed" in capsys.readouterr().out
    (run.path / "metrics.json").unlink()
    assert entry(["info", str(run.path)]) == 0


def test_the_references_need_no_run_and_are_those_of_the_manual(capsys):
    assert entry(["info", "--bibtex"]) == 0
    bibtex = capsys.readouterr().out
    root = Path(__file__).parents[3]
    assert bibtex in (root / "docs" / "limitations.md").read_text(encoding="utf-8")
    cff = (root / "CITATION.cff").read_text(encoding="utf-8")
    title, version = (re.search(rf"{key} += {{(.+)}},", bibtex)[1] for key in ("title", "version"))
    assert f'title: "{title}"' in cff
    assert f"version: {version}" in cff


def test_a_missing_run_is_refused(capsys):
    assert entry(["info"]) == 2
    assert "RUN: missing" in capsys.readouterr().err
