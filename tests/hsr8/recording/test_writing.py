"""A run folder that cannot be written: one error, and a readable rest."""

import json
import resource
import shutil

import pytest

from hsr8.cli.main import entry
from hsr8.recording import crash, run_folder
from hsr8.recording.recorder import Recorder
from hsr8.recording.run import open_run
from hsr8.recording.run_folder import RunFolder
from hsr8.recording.stream import SUFFIX

FAST = ("--body", "kinematic", "--camera", "analytic", "--quiet")
TABLES = ("ticks", "records", "frames", "seconds")
RECORDS = [f"{name}{SUFFIX}" for name in TABLES]


def _run(out, *more):
    words = ["run", "quick", "--out", str(out), "--duration", "1.5", *FAST]
    return entry([*words, *more])


@pytest.fixture
def full(monkeypatch):
    """Let one file of every new run folder fail as on a full disk."""

    def plant(name):
        create = RunFolder.create

        def planted(*arguments):
            path = create(*arguments)
            (path / name).symlink_to("/dev/full")
            return path

        monkeypatch.setattr(RunFolder, "create", planted)

    return plant


@pytest.mark.parametrize("name", RECORDS[:2])
def test_a_full_disk_is_one_line_and_noted_in_the_manifest(tmp_path, capfd, full, name):
    full(name)
    assert _run(tmp_path) == 3
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith("hsr8: cannot write the run folder")
    (folder,) = (tmp_path / "quick").iterdir()
    assert json.loads((folder / "manifest.json").read_text())["exit_reason"] == "failed"
    assert not (folder / run_folder.METRICS).exists()
    assert not (folder / crash.FILE).exists()
    assert not list(folder.glob("*.tmp"))


def test_a_run_whose_results_cannot_be_written_fails(tmp_path, capfd, monkeypatch):
    def refuse(path, value):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("hsr8.files.atomic.write_json", refuse)
    assert _run(tmp_path) == 3
    assert "No space left" in capfd.readouterr().err
    assert open_run(tmp_path).manifest["exit_reason"] == "failed"


def test_a_removed_folder_ends_the_run(tmp_path, capfd, monkeypatch):
    append = Recorder.append

    def removing(recorder, tick):
        if tick.number == 250:
            shutil.rmtree(tmp_path)
        append(recorder, tick)

    monkeypatch.setattr(Recorder, "append", removing)
    assert _run(tmp_path) == 3
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith("hsr8: cannot write the run folder")


def test_a_disk_that_is_full_after_a_second_leaves_a_readable_run(tmp_path, capfd):
    assert _run(tmp_path / "whole") == 1
    size = (open_run(tmp_path / "whole").path / f"ticks{SUFFIX}").stat().st_size
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size - 1000, limits[1]))
    try:
        assert _run(tmp_path / "full") == 3
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "cannot write the run folder" in capfd.readouterr().err
    run = open_run(tmp_path / "full")
    assert not run.ended
    assert len(run.ticks) == 200
    assert run.records["time"][-1] == pytest.approx(0.98)
