import re
import shutil

import pytest

from hsr8.cli.main import entry
from hsr8.robots.file import files

LIGHT = ["--camera", "analytic", "--quiet", "--duration", "0.1"]
ROBOT = "hsr8/hsr8.xml"


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        (ROBOT, 'name="l_knee"', 'name="left_knee"', "'l_knee'"),
        (ROBOT, "</mujoco>", "", "XML"),
        (ROBOT, 'mass="1.24"', 'mass="nan"', "'torso_link': mass, got nan kg"),
        (None, "", "", "install hsr8 again"),
    ],
)
def test_an_invalid_model_is_one_line(tmp_path, monkeypatch, capsys, file, old, new, message):
    folder = tmp_path / "models"
    if file:
        shutil.copytree(files.models_dir(), folder)
        text = (folder / file).read_text(encoding="utf-8")
        assert old in text
        (folder / file).write_text(text.replace(old, new), encoding="utf-8")
    monkeypatch.setattr(files, "PACKAGE", tmp_path / "hsr8")
    assert entry(["run", "quick", *LIGHT, "--out", str(tmp_path / "runs")]) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert str(folder) in line
    assert re.search(message, line)
