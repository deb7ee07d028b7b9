from dataclasses import replace

import pytest

from hsr8.errors import ScenarioError
from hsr8.robot_builder import MARGINS, walking_parameters
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario


@pytest.mark.parametrize("key", [".".join(margin) for margin in MARGINS])
def test_a_margin_is_below_half_the_width_of_the_sole_of_the_robot_that_walks(key, monkeypatch):
    robot = load_robot("hsr8")
    half = robot.model.sole.half_width
    scenario = load_scenario("walk", [f"constants.walking.{key}={half}"])
    with pytest.raises(
        ScenarioError, match=f"constants.walking.{key}: .* less than half the width"
    ):
        walking_parameters(robot, scenario)
    monkeypatch.setattr(robot.model, "sole", replace(robot.model.sole, half_width=1.1 * half))
    walking_parameters(robot, scenario)
