"""Every kind of mistake is one message that names its key, with exit code 2, and writes nothing."""

import json
import shlex
from pathlib import Path

import cv2
import numpy as np
import pytest

from hsr8.cli.first_compilation import TEXT
from hsr8.cli.main import entry
from hsr8.recording.run_folder import RunFolder
from hsr8.scenario.loader import load_scenario

LINES = [
    ("rum quick", "rum: unknown command; did you mean 'run'?"),
    ("run", "SCENARIO"),
    ("run quick --sed 3", "--seed N"),
    ("run quick --duration -1e3", "--duration: duration: wrong value, got -1000.0; expected more"),
    ("run quick --robot nobody", "--robot: robot.model: unknown robot 'nobody'"),
    ("run quick --out /dev/null", "cannot write the run folder /dev/null/quick"),
    ("run quick --ros-drive", "--ros-drive"),
    ("run quick --pace -1", "--pace"),
    ("run quick --set n_moving=3", "'world.n_moving'"),
    ("run yrad.toml", "did you mean 'yard.toml'"),
    ("run typo.toml", "typo.toml:2"),
    ("check quick --image x.jpg", "--image x.jpg: wrong suffix; expected .png"),
    ("sweep quick --seeds 0:2 --vary seed=1", "--vary: the seed is not a setting, got seed=1"),
    ("bench --set world.n_static=3", "--set: settings change the suite"),
    ("bench --name a/b", "--name: wrong form, got 'a/b'; expected letters"),
    ("bench compare RUN RUN", "RUN/bench.json: not an entry of hsr8 bench"),
    ("robot check unknown.toml", "feets: unknown key; did you mean 'feet'?"),
    ("robot calibrate hsr8 --out yard.toml", "--out yard.toml: exists; expected a new name"),
    ("robot calibrate hsr8", "robot hsr8 is shipped with hsr8; expected --out FILE"),
    ("info damaged", "manifest.json"),
    ("plot RUN", "nothing to plot from 0 s to 0 s"),
    ("export RUN RUN --csv tables", "--csv: got 2 runs; expected one"),
    ("plot RUN --out a.jpg", ".png, .svg, .pdf"),
    ("color-table image.png", "(0, 0, 250)"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Scenario files, run folders and images, most of them wrong."""
    path = tmp_path_factory.mktemp("mistakes")
    (path / "yard.toml").write_text('extends = "quick"\n')
    (path / "typo.toml").write_text('extends = "quick"\nworld.n_movin = 3\n')
    (path / "text.xml").write_text("not a model")
    (path / "unknown.toml").write_text('model = "none.xml"\nfeets = ["l", "r"]\n')
    for name in ("damaged", "future"):
        (path / name).mkdir()
    (path / "damaged/manifest.json").write_text("{")
    run = RunFolder.create(path, "made", 7)
    RunFolder(run, load_scenario("quick", seed=7), (), "analytic").end("goal", rows={})
    (run / "scenario.toml").write_text("")
    manifest = json.loads((run / "manifest.json").read_text())
    (path / "future/manifest.json").write_text(json.dumps(manifest | {"format": 99}))
    run.rename(path / "RUN")
    image = np.zeros((8, 8, 3), np.uint8)
    cv2.imwrite(str(path / "image.png"), image)
    cv2.imwrite(str(path / "image.mask.png"), image + np.uint8((250, 0, 0)))
    return path


@pytest.mark.parametrize(("line", "expected"), LINES, ids=[line for line, _ in LINES])
def test_a_mistake_is_one_message(folder, monkeypatch, capsys, line, expected):
    monkeypatch.chdir(folder)
    monkeypatch.setattr("hsr8.cli.render.require_gl", lambda: "llvmpipe")
    before = sorted(Path.cwd().rglob("*"))
    assert entry(shlex.split(line)) == 2
    printed = capsys.readouterr()
    message = printed.err.removeprefix("quick, seed 2\n").removeprefix(f"{TEXT}\n")
    assert message.startswith("hsr8: ")
    assert message.count("hsr8: ") == 1
    assert expected in " ".join(message.split())
    assert "Traceback" not in message
    assert printed.out == "" or line.startswith("robot inspect")
    assert sorted(Path.cwd().rglob("*")) == before
