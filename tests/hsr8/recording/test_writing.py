"""A run folder that cannot be written: one error, and a readable rest."""

import json
import resource
import shutil
import subprocess
import sys
from pathlib import Path

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


@pytest.mark.parametrize("name", RECORDS)
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


LOG_TWICE = """
import resource, sys
from pathlib import Path
from hsr8.errors import RecordingFailed
from hsr8.recording.run import open_run
from hsr8.show.log import run_log

run_log.WRITE_TIMEOUT = 1.0
run = open_run(sys.argv[1])
files = {file.name: file.read_bytes() for file in run.path.iterdir()}
limits = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, limits[1]))
try:
    run_log.write_log(run)
except RecordingFailed as error:
    print(error)
resource.setrlimit(resource.RLIMIT_FSIZE, limits)
print({file.name: file.read_bytes() for file in run.path.iterdir()} == files)
print(run_log.write_log(run).stat().st_size > 150_000)
"""


def test_a_log_without_room_leaves_the_run_as_it_is_and_later_ones_possible(tmp_path):
    _run(tmp_path)
    command = [sys.executable, "-c", LOG_TWICE, str(open_run(tmp_path).path)]
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=100)
    failure, unchanged, written = done.stdout.splitlines()
    assert "cannot write the run folder" in failure
    assert (unchanged, written) == ("True", "True")


def test_a_read_only_disk_is_not_a_usage_error(tmp_path, capfd, monkeypatch):
    def refuse(*_, **__):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(Path, "mkdir", refuse)
    assert _run(tmp_path) == 3
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith(f"hsr8: cannot write the run folder {tmp_path / 'quick'}: Read-only")
    assert "--out" in line
