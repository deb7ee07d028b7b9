"""Every mistake is one message with exit code 2 and without a traceback."""

import json
import shlex
from pathlib import Path

import cv2
import numpy as np
import pytest

from hsr8.cli.first_compilation import TEXT
from hsr8.cli.main import entry
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.scenario.loader import load_scenario

LINES = [
    # commands
    ("rum quick", "rum: unknown command; did you mean 'run'?"),
    ("rendr runs/quick", "did you mean 'render'?"),
    ("frobnicate", "commands: run, sweep"),
    ("quick", "quick: unknown command"),
    ("--json list", "--json: unknown command"),
    ("bug-report", "bug-report: unknown command"),
    ("--tyro-print-completion", "got ''; expected bash, zsh, fish"),
    ("--tyro-print-completion tcl", "expected bash, zsh, fish"),
    # options
    ("run", "SCENARIO"),
    ("run quick --sed 3", "--seed N"),
    ("run quick --seed", "Missing value for argument '--seed'"),
    ("run quick --seed abc", "--seed: invalid literal for int() with base 10: 'abc'"),
    ("run quick --seed None", "--seed: invalid literal"),
    ("run quick --seed 1.5", "--seed"),
    ("run quick --seed -1", "seed"),
    ("run quick --duration 5s", "could not convert string to float: '5s'"),
    (
        "run quick --duration -1e3",
        "--duration: duration: wrong value, got -1000.0; expected more than 0",
    ),
    ("run quick --duration nan", "duration"),
    ("run quick --body kinemtic", "('full', 'kinematic')"),
    ("run quick --robot nobody", "--robot: robot.model: unknown robot 'nobody'"),
    ("check quick --robot no.toml", "robot file 'no.toml' does not exist"),
    ("run quick --view", "Missing value for argument '--view'"),
    ("run quick --view webb", "('native', 'web')"),
    ("run quick --json=yes", "Unrecognized options: yes"),
    ("run quick 7", "Unrecognized options: 7"),
    ("run quick --resume", "Unrecognized options: --resume"),
    ("run quick --out /dev/null", "cannot write the run folder /dev/null/quick"),
    ("render a b", "Unrecognized options: b"),
    ("doctor please", "Unrecognized options: please"),
    ("check quick --image x.jpg", "--image x.jpg: wrong suffix; expected .png"),
    ("check quick --image none/x.png", "--image none/x.png: cannot be written: no folder none"),
    ("color-table", "IMAGE"),
    ("schema --out none/s.json", "--out none/s.json: cannot be written"),
    ("sweep quick", "--seeds SEEDS"),
    ("sweep quick --seeds 0-10", "1000:1200"),
    ("sweep quick --seeds -3:3", "-3:3"),
    ("sweep quick --seeds 0:2 --workers 0", "--workers: out of range, got 0"),
    ("sweep quick --seeds 0:2 --timeout -1", "--timeout: out of range, got -1"),
    ("sweep quick --seeds 0:2 --set seed=3", "--set: the seed is not a setting, got seed=3"),
    ("sweep quick --seeds 0:2 --timeout nan", "--timeout: out of range, got nan"),
    ("sweep quick --seeds 0:2 --vary a", "--vary: malformed"),
    ("sweep quick --seeds 0:2 --vary seed=1,2 seed=3", "--vary: a key is repeated"),
    ("sweep quick --seeds 0:2 --vary seed=1", "--vary: the seed is not a setting, got seed=1"),
    ("sweep quick --seeds 0:2 --vary wrld.n=1,2", "world"),
    ("sweep quick --seeds 0:2 --executor slurm", "--executor: unknown executor, got slurm"),
    ("sweep quick --seeds 0:2 --executor local://x", "--executor"),
    # robots
    ("robot", "Expected one of {list, inspect, check, calibrate}"),
    ("robot chek op3", "robot chek: unknown command; did you mean 'check'?"),
    ("robot list op3", "Unrecognized options: op3"),
    ("robot check", "ROBOT"),
    ("robot check hsr9", "unknown robot 'hsr9'; did you mean 'hsr8'?"),
    ("robot check hsr8 --out a.toml", "Unrecognized or misplaced options: --out"),
    ("robot check none.toml", "robot file 'none.toml' does not exist"),
    ("robot check text.xml", "text.xml: got a model; expected a description, which `hsr8 robot"),
    ("robot check damaged.toml", "damaged.toml: cannot be read"),
    ("robot check unknown.toml", "feets: unknown key; did you mean 'feet'?"),
    ("robot check missing.toml", "missing.toml: model: 'none.xml' does not exist in"),
    ("robot check empty", "robot 'empty': not the file of a robot, got a folder; expected"),
    ("robot inspect text.png", "robot 'text.png': not the file of a robot, got the suffix '.png'"),
    ("robot calibrate hsr8 --out a.json", "--out a.json: wrong suffix; expected .toml"),
    ("robot calibrate hsr8 --out none/a.toml", "--out none/a.toml: cannot be written"),
    ("robot calibrate hsr8 --out yard.toml", "--out yard.toml: exists; expected a new name"),
    ("robot calibrate text.xml", "text.xml: got a model"),
    ("robot inspect", "FILE"),
    ("robot inspect nothing", "unknown robot 'nothing'"),
    ("robot inspect none.urdf", "robot file 'none.urdf' does not exist"),
    ("robot inspect text.xml", "text.xml: invalid robot model"),
    ("robot inspect text.urdf", "text.urdf: cannot be read"),
    ("robot inspect ball.xml", "ball.xml: feet: the model has no hinge joints"),
    ("robot inspect hsr8 --write a.toml", "--write a.toml: hsr8 is a description already"),
    ("robot inspect ball.xml --write yard.toml", "--write yard.toml: exists"),
    ("robot inspect ball.xml --write a.xml", "--write a.xml: wrong suffix; expected .toml"),
    ("robot inspect hsr8 --image a.jpg", "--image a.jpg: wrong suffix; expected .png"),
    # settings and scenarios
    ("run quik", "did you mean 'quick'"),
    ("run yrad.toml", "did you mean 'yard.toml'"),
    ("run runs/quick", "runs/quick"),
    ("run quick --set", "--set: missing value; expected KEY=VALUE"),
    ("run quick --set nonsense", "nonsense"),
    ("run quick --set world.n_movin=3", "did you mean 'n_moving'"),
    ("run quick --set n_moving=3", "'world.n_moving'"),
    ("run quick --set wrld.n_moving=3", "world"),
    ("run quick --set world.n_moving=many", "n_moving"),
    ("run quick --set world.n_moving=-1", "n_moving"),
    ("run quick --set camera.width=100000", "camera.width"),
    ("run quick --set navigation.gaze.mode=stare", "navigation.gaze.mode"),
    ("run quick --set camera.source=egl", "camera.source"),
    ("run quick --set plugin.planner=nope.py:A", "cannot read nope.py"),
    ("run quick --set plugin.walker=a.py", 'wrong form, got "a.py"; expected FILE.py:CLASS with a'),
    ("run quick --set vision.color_table=no.npz", "vision.color_table"),
    ("run typo.toml", "typo.toml:2"),
    ("run broken.toml", "broken.toml"),
    ("check typo.toml", "did you mean 'n_moving'"),
    ("check orphan.toml", "orphan.toml"),
    ("check empty", "empty"),
    # run folders
    ("info nowhere", "nowhere: no such run folder"),
    ("info yard.toml", "yard.toml"),
    ("info damaged", "manifest.json"),
    ("info future", "format"),
    ("diff RUN nowhere", "nowhere"),
    ("diff RUN RUN", "RUN"),
    ("compare nowhere RUN", "nowhere"),
    ("compare empty RUN", "empty"),
    ("verify RUN", "RUN"),
    ("replay RUN", "scenario.toml"),
    ("plot RUN --what speed", "walking"),
    ("plot RUN", "nothing to plot from 0 s to 0 s"),
    ("export", "export: nothing to export; expected --bag"),
    ("export --bag bag", "--bag: got 0 runs; expected one"),
    ("export --lerobot dataset", "--lerobot: got 0 runs; expected at least one"),
    ("export RUN RUN --csv tables", "--csv: got 2 runs; expected one"),
    ("export RUN --csv empty", "--csv empty: exists; expected a new name"),
    ("export nowhere --csv tables", "nowhere: no such run folder"),
    ("export --urdf text.urdf", "--urdf text.urdf: exists; expected a new name"),
    ("export --urdf robot.xml", "--urdf robot.xml: wrong suffix; expected .urdf"),
    ("render RUN --size big", "--size: got 'big'; expected WIDTHxHEIGHT"),
    ("render RUN --size -5x5", "--size: got '-5x5'"),
    ("render RUN --fps ten", "--fps"),
    ("render RUN --fps 0", "--fps: out of range, got 0; expected 1 to 120"),
    ("render RUN --speed -inf", "--speed: out of range, got -inf"),
    # images and models
    ("color-table none.png", "none.png: cannot be read"),
    ("color-table unmasked.png", "unmasked.mask.png"),
    ("color-table text.png", "text.png"),
    ("color-table image.png", "(0, 0, 250)"),
    ("color-table image.png --out table.txt", "--out table.txt: wrong suffix; expected .npz"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Scenario files, run folders and images, most of them wrong."""
    path = tmp_path_factory.mktemp("mistakes")
    (path / "yard.toml").write_text('extends = "quick"\n')
    (path / "typo.toml").write_text('extends = "quick"\nworld.n_movin = 3\n')
    (path / "broken.toml").write_text("extends = \n")
    (path / "orphan.toml").write_text('extends = "nothing"\n')
    (path / "text.xml").write_text("not a model")
    (path / "text.urdf").write_text("not a model")
    ball = "<body><freejoint/><geom size='1'/></body>"
    (path / "ball.xml").write_text(f"<mujoco><worldbody>{ball}</worldbody></mujoco>")
    (path / "damaged.toml").write_text("model = ")
    robot = 'model = "none.xml"\nfeet = ["l", "r"]\n'
    (path / "missing.toml").write_text(robot)
    (path / "unknown.toml").write_text(robot.replace("feet", "feets"))
    for name in ("runs/quick", "empty", "damaged", "future"):
        (path / name).mkdir(parents=True)
    (path / "damaged/manifest.json").write_text("{")
    run = RunFolder.create(path, "made", 7)
    RunFolder(run, load_scenario("quick", seed=7), (), "analytic").end("goal", rows={})
    (run / "scenario.toml").write_text("")
    manifest = json.loads((run / "manifest.json").read_text())
    (path / "future/manifest.json").write_text(json.dumps(manifest | {"format": 99}))
    run.rename(path / "RUN")
    image = np.zeros((8, 8, 3), np.uint8)
    for name in ("unmasked.png", "image.png"):
        cv2.imwrite(str(path / name), image)
    cv2.imwrite(str(path / "image.mask.png"), image + np.uint8((250, 0, 0)))
    (path / "text.png").write_text("not an image")
    return path


@pytest.fixture(autouse=True)
def in_folder(folder, monkeypatch):
    monkeypatch.chdir(folder)
    monkeypatch.setattr("hsr8.cli.render.require_gl", lambda: "llvmpipe")


@pytest.mark.parametrize(("line", "expected"), LINES, ids=[line for line, _ in LINES])
def test_a_mistake_is_one_message(line, expected, capsys):
    before = sorted(Path.cwd().rglob("*"))
    assert entry(shlex.split(line)) == 2
    printed = capsys.readouterr()
    message = printed.err.removeprefix("quick, seed 2\n").removeprefix(f"{TEXT}\n")
    assert message.startswith("hsr8: ")
    assert message.count("hsr8: ") == 1
    assert expected in " ".join(message.split())
    assert "Traceback" not in message
    assert printed.out == "" or line.startswith(("verify", "plot", "robot inspect"))
    assert sorted(Path.cwd().rglob("*")) == before


def test_missing_models_are_one_message(folder, monkeypatch, capsys):
    monkeypatch.setattr("hsr8.robots.file.files.PACKAGE", folder / "hsr8")
    assert entry(["run", "quick", "--camera", "analytic", "--quiet"]) == 2
    message = capsys.readouterr().err
    assert message.startswith("hsr8: ")
    assert "models" in message
