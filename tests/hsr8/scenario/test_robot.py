"""The robot of a scenario: its file, and joints and bodies that are its own."""

import pytest

from hsr8.errors import ScenarioError
from hsr8.robots.loaded import load_robot
from hsr8.scenario.layers import Layer
from hsr8.scenario.loader import load_scenario
from tests.hsr8.robots.mesh_humanoid import write_robot
from tests.hsr8.robots.unrehearsed import unrehearsed_robots


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


STUCK = 'fault=[{{kind="servo-stuck",joint="{}"}}]'
PUSH = 'fault=[{{kind="push",magnitude=1.0,body="{}"}}]'
RANDOM = 'disturbance.random.body="{}"'


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    with unrehearsed_robots():
        yield write_robot(tmp_path_factory.mktemp("robot"))


def load(file, *settings):
    return load_scenario("push", [f"robot.model={file}", 'robot.body="full"', *settings])


@pytest.mark.parametrize("setting", [STUCK, PUSH, RANDOM])
@pytest.mark.parametrize("name", ["l_ankle"])
def test_an_unknown_joint_or_body_is_one_mistake_with_the_names_of_the_robot(file, setting, name):
    with pytest.raises(ScenarioError) as error:
        load(file, setting.format(name))
    robot, message = load_robot(file), str(error.value)
    names = robot.model.names if setting is STUCK else robot.body_names()
    assert "1 mistake" in message
    assert f"'{name}'" in message
    assert all(known in message for known in names)


def test_every_joint_and_body_of_the_robot_is_known(file):
    robot = load_robot(file)
    for joint in (*robot.model.names, "legs", "all"):
        (fault,) = load(file, STUCK.format(joint)).fault
        assert set(fault.joints(robot.model.names)) <= set(range(len(robot.model.names)))
    for body in (*robot.body_names(), "trunk"):
        (push,) = load(file, PUSH.format(body)).fault
        assert robot.body_name(push.body) in robot.body_names()


def test_the_default_push_acts_on_the_trunk(file):
    assert load_robot(file).body_name(load(file).disturbance.random.body) == "torso"
    assert load_robot("hsr8").body_name("trunk") == "torso_link"


def test_getting_up_is_refused_for_another_robot(file):
    with pytest.raises(ScenarioError, match=r"get_up\.enabled: .*hsr8.* only, got"):
        load(file, "walking.get_up.enabled=true")
