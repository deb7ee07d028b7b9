import pytest

from hsr8.scenario.layers import Layer
from hsr8.scenario.loader import load_scenario


@pytest.fixture
def folders(tmp_path, monkeypatch):
    """A robot next to a scenario, another one in the working folder."""
    for name in ("scenarios", "elsewhere"):
        (tmp_path / name).mkdir()
        (tmp_path / name / f"{name}.toml").touch()
        (tmp_path / name / "both.toml").touch()
    monkeypatch.chdir(tmp_path / "elsewhere")
    return tmp_path


@pytest.mark.parametrize(
    ("model", "file"),
    [
        ("op3", "op3"),
        ("scenarios.toml", "{}/scenarios/scenarios.toml"),
        ("elsewhere.toml", "{}/elsewhere/elsewhere.toml"),
        ("both.toml", "{}/scenarios/both.toml"),
        ("../elsewhere/elsewhere.toml", "{}/scenarios/../elsewhere/elsewhere.toml"),
        ("none.toml", "none.toml"),
    ],
)
def test_a_file_is_searched_next_to_the_scenario_and_in_the_working_folder(model, file, folders):
    table = {"robot": {"model": model, "radius": 0.1}, "seed": 1}
    absolute = Layer(table, str(folders / "scenarios" / "this.toml")).located()
    assert absolute == {
        "robot": {"model": file.format(folders), "radius": 0.1},
        "seed": 1,
    }
    assert table["robot"]["model"] == model


def test_the_home_folder_is_expanded(folders, monkeypatch):
    monkeypatch.setenv("HOME", str(folders / "elsewhere"))
    table = Layer({"robot": {"model": "~/elsewhere.toml"}}, str(folders / "this.toml")).located()
    assert table["robot"]["model"] == str(folders / "elsewhere" / "elsewhere.toml")


def test_a_scenario_has_the_absolute_path_of_its_robot(tmp_path, monkeypatch):
    text = 'model = "hsr8/hsr8.xml"\nfeet = ["l_foot_link", "r_foot_link"]\n'
    (tmp_path / "mine.toml").write_text(text)
    (tmp_path / "yard.toml").write_text('extends = "walk"\nrobot.model = "mine.toml"\n')
    file = str(tmp_path / "mine.toml")
    assert load_scenario(str(tmp_path / "yard.toml")).robot.model == file
    monkeypatch.chdir(tmp_path)
    assert load_scenario("yard.toml").robot.model == file
    assert load_scenario("walk", ["robot.model=mine.toml"]).robot.model == file
    options = {"--robot": {"robot": {"model": "mine.toml"}}}
    assert load_scenario("walk", options=options).robot.model == file
