import json
import re
from pathlib import Path

import pytest

from hsr8.cli import doctor, yardstick
from hsr8.cli.main import entry
from hsr8.process.gl import APT_LINE, VULKAN_LINE
from hsr8.robots.file import files


@pytest.fixture(autouse=True)
def nothing_asked(monkeypatch):
    monkeypatch.setattr(doctor, "REQUESTED", "")


@pytest.mark.parametrize(
    ("renderers", "states"),
    [
        ({"egl": "llvmpipe (LLVM 15)", "osmesa": None}, ["ok", "note"]),
        ({"egl": "NVIDIA H200", "osmesa": None}, ["ok", "note"]),
        ({"egl": None, "osmesa": None}, ["note", "note", "missing"]),
    ],
)
def test_one_backend_is_enough(renderers, states):
    assert [f.state for f in doctor.opengl(renderers)] == states


def test_without_a_backend_the_remedy_is_printed_and_the_code_is_2(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "probe", lambda backend: None)
    assert entry(["doctor"]) == 2
    assert APT_LINE in " ".join(capsys.readouterr().out.split())


def test_json_has_all_findings(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "probe", lambda backend: "llvmpipe")
    assert entry(["doctor", "--json"]) == 0
    findings = {f["name"]: f for f in json.loads(capsys.readouterr().out)["findings"]}
    assert findings["mujoco"]["text"].startswith("4.0")
    assert findings["models"]["state"] == "ok"
    assert "processor" in findings["OpenGL egl"]["text"]


def test_missing_models_are_reported(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(doctor, "probe", lambda backend: "llvmpipe")
    monkeypatch.setattr(files, "PACKAGE", tmp_path / "hsr8")
    assert entry(["doctor", "--json"]) == 2
    findings = {f["name"]: f for f in json.loads(capsys.readouterr().out)["findings"]}
    assert findings["models"]["state"] == "missing"


def test_a_backend_that_fails_is_a_note_not_an_error(monkeypatch):
    monkeypatch.setattr(doctor, "PROBE", "raise SystemExit(1)")
    assert doctor.probe("egl") is None
    monkeypatch.setattr(doctor, "PROBE", "print('a renderer')")
    assert doctor.probe("egl") == "a renderer"


def test_a_requested_backend_must_draw(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "REQUESTED", "osmesa")
    monkeypatch.setattr(doctor, "probe", lambda backend: "llvmpipe" if backend == "egl" else None)
    assert entry(["doctor"]) == 2
    assert "unset MUJOCO_GL" in " ".join(capsys.readouterr().out.split())
    monkeypatch.setattr(doctor, "REQUESTED", "egl")
    assert entry(["doctor"]) == 0


def test_missing_vulkan_is_a_note(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(doctor, "probe", lambda backend: "llvmpipe")
    monkeypatch.setattr(doctor, "VULKAN_FOLDERS", (str(tmp_path),))
    assert entry(["doctor"]) == 0
    assert VULKAN_LINE in " ".join(capsys.readouterr().out.split())
    (tmp_path / "vulkan/icd.d").mkdir(parents=True)
    (tmp_path / "vulkan/icd.d/lvp.json").touch()
    entry(["doctor"])
    assert VULKAN_LINE not in " ".join(capsys.readouterr().out.split())


def test_the_speed_of_a_run_is_expected_from_a_physics_step(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "probe", lambda backend: "llvmpipe")
    assert entry(["doctor", "--json"]) == 0
    findings = {f["name"]: f for f in json.loads(capsys.readouterr().out)["findings"]}
    step, expected = map(float, re.findall(r"([\d.]+) (?:us|times)", findings["speed"]["text"]))
    assert 2.0 < step < 2000.0
    assert expected == pytest.approx(yardstick.COURSE / step, rel=0.1)


def test_a_checkout_that_is_installed_as_a_copy_is_reported(tmp_path):
    here = Path(doctor.__file__).parents[2]
    assert doctor.copied_checkout(here, here / "docs") == []
    assert doctor.copied_checkout(here, tmp_path) == []
    (finding,) = doctor.copied_checkout(tmp_path, here / "docs")
    assert (finding.state, str(here) in finding.text) == ("note", True)
