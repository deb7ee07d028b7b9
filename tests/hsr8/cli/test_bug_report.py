import json
import zipfile
from pathlib import Path

import pytest

from hsr8.cli import bug_report
from hsr8.cli.doctor import Finding
from hsr8.cli.main import entry
from hsr8.recorder.run.manifest import FORMAT


@pytest.fixture(autouse=True)
def quick_doctor(monkeypatch):
    """The doctor tries OpenGL for seconds; here it finds one thing."""
    home = Path.home()
    monkeypatch.setattr(
        "hsr8.cli.bug_report.examine", lambda: [Finding("hsr8", "ok", f"{home}/venv")]
    )


@pytest.fixture
def folder(tmp_path):
    """A run folder as a crash leaves it."""
    manifest = {"seed": 1, "exit_reason": "running", "format": FORMAT}
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    (tmp_path / "crash.txt").write_text("Traceback: oh no")
    (tmp_path / "frames.jsonl").write_text("x" * (bug_report.LARGEST + 5) + "END")
    (tmp_path / "log.rrd").write_bytes(b"large and not sent")
    return tmp_path


def test_the_report_holds_the_run_and_no_pictures(folder, tmp_path, capsys):
    out = tmp_path / "report.zip"
    assert entry(["bug-report", str(folder), "--out", str(out), "--json"]) == 0
    with zipfile.ZipFile(out) as archive:
        assert archive.namelist() == json.loads(capsys.readouterr().out)["files"]
        assert archive.read("run/crash.txt") == b"Traceback: oh no"
        frames = archive.read("run/frames.jsonl")
        assert len(frames) == bug_report.LARGEST
        assert frames.endswith(b"END")
        assert "run/log.rrd" not in archive.namelist()
        assert json.loads(archive.read("run/sizes.json"))["log.rrd"] == 18
        assert str(Path.home()) not in archive.read("doctor.json").decode()


def test_without_a_run_it_is_about_the_machine(tmp_path, capsys):
    out = tmp_path / "report.zip"
    assert entry(["bug-report", "--out", str(out)]) == 0
    assert "doctor.json" in capsys.readouterr().out
    with zipfile.ZipFile(out) as archive:
        assert archive.namelist() == ["README.txt", "doctor.json"]


def test_nothing_is_overwritten(tmp_path, capsys):
    out = tmp_path / "report.zip"
    out.write_text("mine")
    assert entry(["bug-report", "--out", str(out)]) == 2
    assert "is there already" in capsys.readouterr().err
    assert out.read_text() == "mine"


def test_a_place_that_cannot_be_written_is_a_usage_error(tmp_path, capsys):
    assert entry(["bug-report", "--out", str(tmp_path / "no" / "report.zip")]) == 2
    assert "cannot be written" in capsys.readouterr().err
