import shutil

import pytest

from hsr8.cli.main import entry
from hsr8.world.model import models

LIGHT = ["--body", "kinematic", "--camera", "analytic", "--quiet", "--no-log", "--duration", "0.1"]


@pytest.mark.parametrize(
    ("file", "old", "new", "told"),
    [
        ("hsr8/hsr8.xml", 'name="l_knee"', 'name="left_knee"', "'l_knee'"),
        ("hsr8/hsr8.xml", 'key name="walk_ready"', 'key name="ready"', "'walk_ready'"),
        ("hsr8/hsr8.xml", "</mujoco>", "", "XML"),
        ("hsr8/hsr8.xml", 'mass="0.08"', 'mass="-0.08"', "mass and inertia of moving bodies"),
        ("hsr8/hsr8.xml", 'mass="1.24"', 'mass="nan"', "body_mass is not finite"),
        ("hsr8/hsr8.xml", 'range="-2.2 0.05"', 'range="0.05 -2.2"', "range must rise"),
        ("hsr8/hsr8.xml", 'forcerange="-6 6"', 'forcerange="6 -6"', "forcerange must rise"),
        ("hsr8/hsr8.xml", 'armature="0.005"', 'armature="-0.005"', "armature must not be negative"),
        ("hsr8/hsr8.xml", 'kp="120"', 'kp="-120"', "kp must be positive"),
        ("hsr8/hsr8.xml", 'damping="0.1"', 'damping="inf"', "not finite"),
        ("field/vision.xml", 'name="floor"', 'name="ground"', "'floor'"),
    ],
)
def test_a_model_that_will_not_do_is_one_line(tmp_path, monkeypatch, capsys, file, old, new, told):
    folder = tmp_path / "models"
    shutil.copytree(models.models_dir(), folder)
    text = (folder / file).read_text(encoding="utf-8")
    assert old in text
    (folder / file).write_text(text.replace(old, new), encoding="utf-8")
    monkeypatch.setattr(models, "PACKAGE", tmp_path / "hsr8")
    assert entry(["run", "quick", *LIGHT, "--out", str(tmp_path / "runs")]) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert str(folder) in line
    assert told in line


def test_a_physics_step_that_will_not_do_is_one_line(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "models"
    shutil.copytree(models.models_dir(), folder)
    file = folder / "hsr8" / "hsr8.xml"
    text = file.read_text(encoding="utf-8")
    assert 'timestep="0.0025"' in text
    file.write_text(text.replace('timestep="0.0025"', 'timestep="0.004"'), encoding="utf-8")
    monkeypatch.setattr(models, "PACKAGE", tmp_path / "hsr8")
    full = ["--camera", "analytic", "--quiet", "--no-log", "--duration", "0.1"]
    assert entry(["run", "quick", *full, "--out", str(tmp_path / "runs")]) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert str(folder) in line
    assert "no multiple of the physics step 0.004 s" in line


def test_models_that_are_nowhere_are_one_line(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(models, "PACKAGE", tmp_path / "hsr8")
    assert entry(["run", "quick", *LIGHT, "--out", str(tmp_path / "runs")]) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert str(tmp_path) in line
    assert "install" in line
