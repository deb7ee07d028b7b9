"""Files that can no longer be written: full disk, folder that is gone."""

import json
import shutil
from pathlib import Path

import pytest

from hsr8.cli.main import entry
from hsr8.errors import RecordingFailed
from hsr8.recorder.files.writing import refusal
from hsr8.recorder.log import rerun_log
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.recorder.run.run_reader import open_run

FAST = ("--body", "kinematic", "--camera", "analytic", "--quiet")
RECORDS = (
    run_folder.TRAJECTORY,
    run_folder.WALKING,
    run_folder.MEASUREMENTS,
    run_folder.TAPE,
    run_folder.FRAMES,
    run_folder.LOG,
)


def _run(out, *more):
    words = ["run", "quick", "--out", str(out), "--duration", "1.5", *FAST]
    return entry([*words, *more])


@pytest.fixture
def full_device():
    return Path("/dev/full")


@pytest.fixture
def full(monkeypatch, full_device):
    """Every new run folder has one file that takes nothing, as on a full disk."""

    def plant(name):
        create = RunFolder.create

        def planted(*arguments):
            path = create(*arguments)
            (path / name).unlink(missing_ok=True)
            (path / name).symlink_to(full_device)
            return path

        monkeypatch.setattr(RunFolder, "create", planted)

    monkeypatch.setattr(rerun_log, "PATIENCE", 1.0)
    monkeypatch.setattr(run_folder, "next_log", lambda path: path / run_folder.LOG)
    return plant


@pytest.mark.parametrize("name", RECORDS)
def test_a_full_disk_is_one_line_and_the_manifest_says_so(tmp_path, capfd, full, name):
    earlier = tmp_path / "quick" / "1-aaaaaa"
    earlier.mkdir(parents=True)
    (earlier / "log.rrd").write_bytes(b"as it was")
    full(name)
    assert _run(tmp_path, *(() if name == run_folder.LOG else ("--no-log",))) == 3
    said = capfd.readouterr().err.splitlines()
    assert len(said) == 1, said
    assert said[0].startswith("hsr8: cannot write the run folder")
    folder = next(path for path in (tmp_path / "quick").iterdir() if path != earlier)
    assert json.loads((folder / "manifest.json").read_text())["exit_reason"] == "failed"
    assert not (folder / run_folder.METRICS).exists()
    assert not (folder / run_folder.CRASH).exists()
    assert not list(folder.glob("*.tmp"))
    assert (earlier / "log.rrd").read_bytes() == b"as it was"


def test_results_that_cannot_be_written_are_a_failed_run(tmp_path, capfd, monkeypatch):
    def refuse(path, value):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("hsr8.recorder.files.atomic.write_json", refuse)
    assert _run(tmp_path, "--no-log") == 3
    assert "No space left" in capfd.readouterr().err
    assert open_run(tmp_path).manifest["exit_reason"] == "failed"


@pytest.fixture
def folder(tmp_path):
    path = RunFolder.create(tmp_path, "quick", 7)
    return RunFolder(path, Manifest.now("quick", 7, ("hsr8",), "analytic"), "", movers=1)


def test_an_event_that_cannot_be_written_is_told(folder, full_device):
    folder._events = full_device.open("a", buffering=1)
    with pytest.raises(RecordingFailed, match="No space left"):
        folder.on_event(1.0, "fall", "it fell")


def test_a_folder_that_vanishes_ends_the_run(folder, walk):
    first, *_, last = walk(2.0)
    folder.on_record(first)
    shutil.rmtree(folder.path)
    with pytest.raises(RecordingFailed, match="no longer there"):
        folder.on_record(last)
    with pytest.raises(RecordingFailed):
        folder.close("goal")


def test_a_read_only_disk_is_no_usage_error(tmp_path, capfd, monkeypatch):
    def refuse(*_, **__):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(Path, "mkdir", refuse)
    assert _run(tmp_path, "--no-log") == 3
    (said,) = capfd.readouterr().err.splitlines()
    assert said.startswith(f"hsr8: cannot write the run folder {tmp_path / 'quick'}: Read-only")
    assert "--out" in said


def test_the_system_says_what_a_library_does_not(tmp_path):
    assert str(refusal(tmp_path, "it ended")).endswith("it ended")
    assert list(tmp_path.iterdir()) == []
    assert "No such file" in str(refusal(tmp_path / "gone", "it ended"))
