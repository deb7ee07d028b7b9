"""Outputs of commands: complete or absent, never through a link, checked before the work."""

import json
import os
import shutil
import signal

import psutil
import pytest

from hsr8.api import run as api_run
from hsr8.cli.main import entry
from hsr8.errors import RenderingUnavailable
from hsr8.recording import run_folder
from hsr8.recording.run import open_run
from hsr8.recording.run_folder import RunFolder
from hsr8.robots.file.locate import find_description
from hsr8.robots.loaded import load_robot
from hsr8.show.log.run_log import RunLog, write_log
from hsr8.simulation.loop import Simulation

FAST = ("--body", "kinematic", "--camera", "analytic")


@pytest.fixture
def run(quick_run):
    return quick_run


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("plot RUN --what tilt", "tilt.png"),
        ("check quick --image FILE", "world.png"),
        ("schema --out FILE", "schema.json"),
        ("replay RUN --screenshot FILE", "log.png"),
        pytest.param("render RUN --out FILE --size 64x64", "a.png", marks=pytest.mark.gl),
        pytest.param("render RUN --size 64x64 --fps 2", "video.mp4", marks=pytest.mark.gl),
    ],
)
def test_a_link_in_place_of_an_output_is_replaced(run, tmp_path, monkeypatch, command, name):
    monkeypatch.setattr("hsr8.show.viewer.screenshot", lambda *_: b"png")
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "kept").write_text("as it was")
    file = run.path / name
    file.symlink_to(outside / "kept")
    places = {"RUN": run.path, "FILE": file, "OTHER": tmp_path / "other.png"}
    assert entry([str(places.get(word, word)) for word in command.split()]) == 0
    assert file.is_file()
    assert not file.is_symlink()
    assert [path.read_text() for path in outside.iterdir()] == ["as it was"]


def test_a_log_is_not_made_through_a_link(run, tmp_path):
    (run.path / run_folder.LOG).symlink_to(tmp_path / "new")
    assert run.log_file is None
    assert write_log(run) == run.log_file
    assert not run.log_file.is_symlink()
    assert not (tmp_path / "new").exists()


def test_an_interrupted_log_does_not_count_as_complete(run, monkeypatch):
    def interrupted(self, tables):
        raise KeyboardInterrupt

    monkeypatch.setattr(RunLog, "add", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_log(run)
    assert run.log_file is None
    assert not [path for path in run.path.iterdir() if "rrd" in path.name or path.is_dir()]


@pytest.mark.usefixtures("bound_by_file_modes")
@pytest.mark.parametrize("python", [False, True])
def test_an_unwritable_folder_is_reported_before_any_work(tmp_path, monkeypatch, capsys, python):
    def never(*_, **__):
        raise AssertionError("the simulation was built")

    monkeypatch.setattr("hsr8.driver.Simulation", never)
    (tmp_path / "closed").mkdir(mode=0o500)
    if python:
        with pytest.raises(Exception, match=r"cannot write the run folder .*Permission denied"):
            api_run("quick", out=tmp_path / "closed")
    else:
        assert entry(["run", "quick", *FAST, "--out", str(tmp_path / "closed")]) in (2, 3)
        assert "cannot write the run folder" in capsys.readouterr().err


def test_a_run_that_cannot_begin_leaves_no_folder(tmp_path, capsys):
    words = ["run", "quick", *FAST, "--set", "world.n_static=60", "world.size=[2.0,2.0]"]
    assert entry([*words, "--out", str(tmp_path)]) == 2
    assert not list(tmp_path.glob("*/*"))


@pytest.mark.usefixtures("bound_by_file_modes")
@pytest.mark.parametrize(
    ("command", "option"),
    [
        ("render RUN --out closed/a.mp4", "--out"),
        ("check quick --image closed/a.png", "--image"),
        ("robot inspect hsr8 --write closed/a.toml", "--write"),
        ("export RUN --csv closed/a", "--csv"),
        ("export --urdf closed/a.urdf", "--urdf"),
    ],
)
def test_an_unwritable_output_is_reported_before_any_work(
    run, tmp_path, monkeypatch, capsys, command, option
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "closed").mkdir(mode=0o500)
    words = [str(run.path) if word == "RUN" else word for word in command.split()]
    assert entry(words) == 2
    error = capsys.readouterr().err
    assert f"hsr8: {option} closed" in error
    assert "the folder closed is not writable" in error


def test_equal_targets_of_an_export_are_refused(run, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "runs").mkdir()
    words = ["export", str(run.path), "--csv", "out", "--lerobot", "./runs/../out"]
    assert entry(words) == 2
    assert "--lerobot runs/../out: the same as --csv; expected another" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_failed_export_leaves_nothing(run, tmp_path, monkeypatch, capsys, error):
    def failing(run, folder):
        folder.mkdir()
        raise error

    monkeypatch.setattr("hsr8.cli.export.write_csv", failing)
    out = tmp_path / "out"
    out.mkdir()
    words = ["--urdf", "a.urdf", "--csv", "tables", "--bag", "bag"]
    words = [word if word.startswith("--") else str(out / word) for word in words]
    assert entry(["export", str(run.path), *words]) == (2 if isinstance(error, OSError) else 130)
    assert not list(out.iterdir())
    (out / "dangling").symlink_to(tmp_path / "elsewhere")
    assert entry(["export", str(run.path), "--csv", str(out / "dangling")]) == 2
    assert "dangling: exists" in capsys.readouterr().err


def test_a_failed_bag_follows_the_results(tmp_path, monkeypatch, capsys):
    def failing(run, folder):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("hsr8.export.bag.write_bag", failing)
    words = ["run", "quick", *FAST, "--duration", "0.5", "--bag", "--out", str(tmp_path)]
    assert entry([*words, "--json"]) == 2
    printed = capsys.readouterr()
    results = json.loads(printed.out)
    assert results["exit_reason"] == "timeout"
    (failure,) = results["failed_outputs"]
    assert failure.endswith("bag: cannot be written: No space left on device")
    assert failure in printed.err
    assert entry(words) == 2
    printed = capsys.readouterr()
    assert "timeout at 0.5 s" in printed.out
    assert "bag: cannot be written: No space left on device" in printed.err


@pytest.mark.gl
@pytest.mark.parametrize("interrupted", [False, True])
def test_a_run_without_motion_or_an_end_has_no_video(tmp_path, monkeypatch, capsys, interrupted):
    step = Simulation.step

    def stopping(self):
        if interrupted and self.tick == 40:
            os.kill(os.getpid(), signal.SIGTERM)
        return step(self)

    monkeypatch.setattr(Simulation, "step", stopping)
    duration = "1.0" if interrupted else "0.005"
    words = ["run", "quick", *FAST, "--duration", duration, "--video", "--out", str(tmp_path)]
    assert entry(words) == (130 if interrupted else 1)
    run = open_run(tmp_path)
    assert f"; hsr8 render {run.path}\n" in capsys.readouterr().err
    assert not (run.path / run_folder.VIDEO).exists()


def test_the_urdf_of_an_export_is_that_of_the_robot_of_the_run(tmp_path, monkeypatch):
    shutil.copy(find_description("hsr8"), tmp_path / "mine.toml")
    words = ["run", "quick", *FAST, "--duration", "0.2", "--quiet", "--out", str(tmp_path)]
    entry([*words, "--robot", str(tmp_path / "mine.toml")])
    loaded = []

    def load(name):
        loaded.append(name)
        return load_robot(name)

    monkeypatch.setattr("hsr8.cli.export.load_robot", load)
    for name, given in (("a", []), ("b", ["--robot", "hsr8"])):
        file = tmp_path / f"{name}.urdf"
        assert entry(["export", str(tmp_path), "--urdf", str(file), *given]) == 0
    assert loaded == [str(tmp_path / "mine.toml"), "hsr8"]


@pytest.mark.gl
def test_a_failed_video_is_reported(tmp_path, monkeypatch, capsys):
    create = RunFolder.create

    def planted(*arguments):
        path = create(*arguments)
        (path / run_folder.VIDEO).mkdir()
        return path

    monkeypatch.setattr(RunFolder, "create", planted)
    words = ["run", "quick", *FAST, "--duration", "0.5", "--video", "--json"]
    assert entry([*words, "--out", str(tmp_path)]) == 2
    (failure,) = json.loads(capsys.readouterr().out)["failed_outputs"]
    assert failure.endswith("video.mp4: cannot be written: it is a folder")


def test_a_camera_that_fails_leaves_no_open_file(tmp_path, monkeypatch):
    def failing(*_):
        raise RenderingUnavailable("no OpenGL")

    monkeypatch.setattr("hsr8.simulation.loop.HeadCamera.open", failing)
    monkeypatch.setattr("hsr8.driver.require_gl", lambda: "none")
    with pytest.raises(RenderingUnavailable) as error:  # whose frames hold the recorder
        api_run("quick", out=tmp_path)
    assert error.traceback
    assert not [file for file in psutil.Process().open_files() if str(tmp_path) in file.path]
