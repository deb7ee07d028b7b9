"""Obstacles of unknown height."""

from dataclasses import replace

import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.robot_builder import camera_model
from hsr8.world.field.generator import draw_layout

HEIGHT = "world.height=[0.09, 0.27]"


@pytest.mark.parametrize("name", ["crowd", "circle", "fig4a"])
def test_only_the_heights_differ_from_the_world_of_one_height(name):
    scenario = load_scenario(name, [HEIGHT])
    low, drawn = draw_layout(load_scenario(name), 3), draw_layout(scenario, 3)
    heights = [o.height for o in drawn.obstacles]
    assert all(0.09 <= height <= 0.27 for height in heights)
    assert len(set(heights)) == len(heights)
    assert tuple(replace(o, height=0.3) for o in drawn.obstacles) == low.obstacles
    view = camera_model(scenario, drawn.sizes)
    assert (view.min_top, view.top) == (0.09, 0.27)


def test_heights_out_of_order_are_refused():
    with pytest.raises(ScenarioError, match=r"world\.height.*first bound"):
        load_scenario("course", ["world.height=[0.3, 0.1]"])
