import json

from hsr8.cli.main import entry
from hsr8.robots.file import locate
from hsr8.robots.file.files import models_dir
from hsr8.robots.file.locate import robot_names


def listed(capsys):
    assert entry(["robot", "list", "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def without_wheels(monkeypatch):
    monkeypatch.delenv("MENAGERIE", raising=False)
    monkeypatch.setattr(locate, "find_spec", lambda name: None)


def test_every_shipped_robot_is_listed(capsys):
    robots = {robot["name"]: robot for robot in listed(capsys)["robots"]}
    assert [*robots] == robot_names()
    assert robots["hsr8"]["model"] == str(models_dir() / "hsr8" / "hsr8.xml")


def test_a_missing_model_has_a_remedy(monkeypatch, capsys):
    without_wheels(monkeypatch)
    result = listed(capsys)
    missing = [robot["name"] for robot in result["robots"] if robot["model"] is None]
    assert missing == [name for name in robot_names() if name != "hsr8"]
    assert [*result["remedies"]] == missing
    assert "pip install envpool-assets" in result["remedies"]["op3"]
    assert "pip install icub-models" in result["remedies"]["icub"]
    assert "pip install jvrc-description" in result["remedies"]["jvrc1"]
    assert "pip install example-robot-data" in result["remedies"]["alexander"]


def test_a_menagerie_of_the_user_is_used(tmp_path, monkeypatch, capsys):
    without_wheels(monkeypatch)
    monkeypatch.setenv("MENAGERIE", str(tmp_path))
    file = tmp_path / "robotis_op3" / "op3.xml"
    file.parent.mkdir()
    file.touch()
    result = listed(capsys)
    models = {robot["name"]: robot["model"] for robot in result["robots"]}
    assert (models["op3"], models["t1"]) == (str(file), None)
    assert "op3" not in result["remedies"]
