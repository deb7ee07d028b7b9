import json
import shutil

import pytest

from hsr8.cli.main import entry
from hsr8.errors import RenderingUnavailable
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.run_reader import open_run


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("runs")
    options = ["--body", "kinematic", "--camera", "analytic", "--duration", "0.5", "--no-log"]
    entry(["run", "quick", *options, "--quiet", "--out", str(out)])
    return out


@pytest.mark.gl
def test_json_is_all_there_is_on_standard_output(run, tmp_path, capsys):
    video = tmp_path / "v.mp4"
    options = ["--size", "192x108", "--fps", "4", "--out", str(video), "--json"]
    assert entry(["render", str(run), *options]) == 0
    made = json.loads(capsys.readouterr().out)
    assert made["video"] == str(video)
    assert made["frames"] == 2
    assert video.exists()


def test_a_start_after_the_end_of_the_run_is_refused(run, capsys, monkeypatch):
    monkeypatch.setattr("hsr8.cli.render.require_gl", lambda: "llvmpipe")
    assert entry(["render", str(run), "--start", "7", "--quiet"]) == 2
    assert "ended at 0.5 s" in capsys.readouterr().err


def test_without_opengl_it_says_so(run, capsys, monkeypatch):
    def unavailable():
        raise RenderingUnavailable("no OpenGL")

    monkeypatch.setattr("hsr8.cli.render.require_gl", unavailable)
    assert entry(["render", str(run)]) == 2
    assert "no OpenGL" in capsys.readouterr().err


@pytest.mark.gl
def test_a_video_in_place_of_a_folder_is_refused(run, tmp_path, capsys):
    video = tmp_path / "v.mp4"
    video.mkdir()
    options = ["--size", "64x64", "--fps", "4", "--out", str(video), "--quiet"]
    assert entry(["render", str(run), *options]) == 2
    assert "cannot be written" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir() if p.suffix == ".part"] == []


def test_a_run_whose_scenario_has_a_key_that_is_gone_names_it(run, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("hsr8.cli.render.require_gl", lambda: "llvmpipe")
    copy = tmp_path / "old"
    shutil.copytree(open_run(run).path, copy)
    file = copy / run_folder.SCENARIO
    file.write_text(file.read_text().replace("n_moving = ", "n_movers = "))
    line = next(k for k, t in enumerate(file.read_text().splitlines(), 1) if "n_movers" in t)
    assert entry(["render", str(copy), "--quiet"]) == 2
    told = capsys.readouterr().err
    assert f"{run_folder.SCENARIO}:{line}" in told
    assert "n_movers" in told
    assert "n_moving" in told  # what it may have meant
