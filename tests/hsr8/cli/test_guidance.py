"""A beginner's wrong command lines are answered with the right ones."""

import shlex
from pathlib import Path

import pytest

from hsr8.cli.guidance import COMMANDS as MEANT
from hsr8.cli.guidance import OPTIONS
from hsr8.cli.main import COMMANDS, entry


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("yard.toml").write_text('extends = "quick"')
    for run in ("runs/quick/7-abc", "sweeps/course"):
        Path(run).mkdir(parents=True)
    Path("runs/quick/7-abc/video.mp4").touch()


@pytest.mark.parametrize(
    ("line", "right"),
    [
        ("quick", "'hsr8 run quick'"),
        ("walk --seed 3", "'hsr8 run walk --seed 3'"),
        ("yard.toml", "'hsr8 run yard.toml'"),
        ("rum quick", "'run'"),
        ("simulate quick", "'run'"),
        ("view runs/quick", "'replay'"),
        ("video runs/quick", "'render'"),
        ("run quik", "'quick'"),
        ("run yrad", "'yard.toml'"),
        ("run yrad.toml", "'yard.toml'"),
        ("run runs/quick", "a scenario's name"),
        ("run quick 7", "--seed 7"),
        ("run quick world.n_moving=3", "--set world.n_moving=3"),
        ("run quick --world.n_moving=3", "--set world.n_moving=3"),
        ("run quick --set n_moving=3", "'world.n_moving'"),
        ("run quick --set world.n_movin=3", "'n_moving'"),
        ("run quick --set method=orca", "'navigation.planner.method'"),
        ("run quick --planner orca", "--set navigation.planner.method=NAME"),
        ("run quick --headless", "no display is needed"),
        ("run quick --sed 3", "--seed"),
        ("run", "SCENARIO"),
        ("render quick", "runs/quick"),
        ("render runs/quik", "runs holds quick"),
        ("render nothing/there", "hsr8 run SCENARIO"),
        ("replay runs/quick/7-abc/video.mp4", "runs/quick/7-abc"),
        ("sweep quick", "--seeds"),
        ("sweep quick --seeds 0-10", "1000:1200"),
        ("compare course quick", "sweeps/course"),
    ],
)
def test_the_right_command_is_named(line, right, capsys):
    assert entry(shlex.split(line)) == 2
    said = capsys.readouterr()
    assert right in " ".join(said.err.split())
    assert "Traceback" not in said.err
    assert said.out == ""


@pytest.mark.parametrize("line", ["help", "help run", "--version", "version"])
def test_what_other_programs_know_is_known(line, capsys):
    assert entry(line.split()) == 0
    assert "hsr8" in capsys.readouterr().out


def test_what_is_named_exists():
    assert set(MEANT.values()) <= set(COMMANDS)
    assert not set(MEANT) & set(COMMANDS)
    keys = [words.split()[1] for words in OPTIONS.values() if words.startswith("--set")]
    for key in keys:
        assert entry(["check", "quick", "--json", "--set", key.replace("NAME", "no-such")]) == 2
