import json

import pytest

from hsr8.cli.main import entry
from hsr8.errors import RenderingUnavailable


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("runs")
    options = ["--body", "kinematic", "--camera", "analytic", "--duration", "0.5"]
    entry(["run", "quick", *options, "--quiet", "--out", str(out)])
    return out


@pytest.mark.gl
def test_json_is_the_only_output(run, tmp_path, capsys):
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


def test_missing_opengl_is_reported(run, capsys, monkeypatch):
    def unavailable():
        raise RenderingUnavailable("no OpenGL")

    monkeypatch.setattr("hsr8.cli.render.require_gl", unavailable)
    assert entry(["render", str(run)]) == 2
    assert "no OpenGL" in capsys.readouterr().err
