import json

import pytest

from hsr8.cli.main import entry
from hsr8.errors import RenderingUnavailable
from hsr8.recording.run import open_run


@pytest.mark.gl
def test_json_is_the_only_output(quick_runs, tmp_path, capsys):
    video = tmp_path / "v.mp4"
    options = ["--size", "192x108", "--fps", "4", "--out", str(video), "--json"]
    assert entry(["render", str(quick_runs), *options]) == 0
    made = json.loads(capsys.readouterr().out)
    assert made["video"] == str(video)
    assert made["frames"] == 4
    assert video.exists()


@pytest.mark.gl
def test_a_run_with_a_video_draws_what_render_draws(tmp_path, capsys):
    words = ["--body", "kinematic", "--camera", "analytic", "--duration", "0.5", "--video"]
    assert entry(["run", "walk", *words, "--out", str(tmp_path)]) <= 1
    path = open_run(tmp_path).path
    assert str(path / "video.mp4") in capsys.readouterr().out
    assert entry(["render", str(path), "--out", str(tmp_path / "again.mp4"), "--quiet"]) == 0
    for suffix in (".mp4", ".png"):
        drawn, again = path / f"video{suffix}", tmp_path / f"again{suffix}"
        assert drawn.read_bytes() == again.read_bytes()


def test_a_start_after_the_end_of_the_run_is_refused(quick_runs, capsys, monkeypatch):
    monkeypatch.setattr("hsr8.cli.render.require_gl", lambda: "llvmpipe")
    assert entry(["render", str(quick_runs), "--from", "7", "--quiet"]) == 2
    assert "ended at 1 s" in capsys.readouterr().err


def test_missing_opengl_is_reported(quick_runs, capsys, monkeypatch):
    def unavailable():
        raise RenderingUnavailable("no OpenGL")

    monkeypatch.setattr("hsr8.cli.render.require_gl", unavailable)
    assert entry(["render", str(quick_runs)]) == 2
    assert "no OpenGL" in capsys.readouterr().err
