import json

import pytest

from hsr8.cli.main import entry


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A short walk, pushed once."""
    out = tmp_path_factory.mktemp("runs")
    push = 'fault=[{kind="push",start=1.0,magnitude=0.3}]'
    settings = ["--set", "command.vx=0.2", "--set", push, "--camera", "analytic"]
    code = entry(["run", "walk", "--duration", "1.5", "--out", str(out), "--quiet", *settings])
    assert code == 0
    return out


def test_a_plot_lies_in_the_run_folder(run, capsys):
    assert entry(["plot", str(run), "--what", "zmp"]) == 0
    (file,) = run.glob("walk/*/zmp.png")
    assert capsys.readouterr().out == f"plot        {file}\n"
    assert file.read_bytes().startswith(b"\x89PNG")


def test_a_part_of_a_run_is_plotted_elsewhere(run, tmp_path, capsys):
    out = tmp_path / "tilt.svg"
    arguments = ["--what", "tilt", "--from", "0.5", "--to", "1.2", "--out", str(out), "--json"]
    assert entry(["plot", str(run), *arguments]) == 0
    assert json.loads(capsys.readouterr().out) == {
        "plot": str(out),
        "what": "tilt",
        "from_s": 0.5,
        "to_s": 1.2,
    }
    assert "walk, seed 0, 0.5 to 1.2 s" in out.read_text()
