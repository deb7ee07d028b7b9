"""Joints and bodies of a scenario are those of its robot."""

import pytest

from hsr8.errors import ScenarioError
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from tests.hsr8.robots.mesh_humanoid import write_robot

STUCK = 'fault=[{{kind="servo-stuck",joint="{}"}}]'
PUSH = 'fault=[{{kind="push",magnitude=1.0,body="{}"}}]'
RANDOM = 'disturbance.random.body="{}"'


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return write_robot(tmp_path_factory.mktemp("robot"))


def load(file, *settings):
    return load_scenario("push", [f"robot.model={file}", 'robot.body="full"', *settings])


@pytest.mark.parametrize("setting", [STUCK, PUSH, RANDOM])
@pytest.mark.parametrize("name", ["l_ankle", "torso_link", "nothing-like-it"])
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
