import json

import pytest

from hsr8.cli.main import entry
from hsr8.errors import RenderingUnavailable


@pytest.mark.gl
def test_json_is_the_only_output(quick_runs, tmp_path, capsys):
    video = tmp_path / "v.mp4"
    options = ["--size", "192x108", "--fps", "4", "--out", str(video), "--json"]
    assert entry(["render", str(quick_runs), *options]) == 0
    made = json.loads(capsys.readouterr().out)
    assert made["video"] == str(video)
    assert made["frames"] == 4
    assert video.exists()


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
