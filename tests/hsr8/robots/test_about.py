"""The facts of shipped robots are those of their models."""

import pytest

from hsr8.robots.description import read_description
from hsr8.robots.loaded import load_robot, read_robot
from hsr8.robots.locate import find_description, installed_model, robot_names


@pytest.mark.parametrize("name", robot_names())
def test_mass_and_joints_are_those_of_the_model(name):
    file = find_description(name)
    description = read_description(file)
    if installed_model(description, file.parent) is None:
        pytest.skip("the model is not installed")
    model = read_robot(description, file).model
    assert description.about.mass == pytest.approx(model.body_subtreemass[1], rel=0.01)
    assert description.about.joints == model.njnt - 1


def test_the_leg_is_that_of_the_model():
    robot = load_robot("hsr8")
    assert robot.description.about.leg == pytest.approx(robot.model.measures().leg, rel=0.01)
