import numpy as np

from hsr8.scenario.loader import load_scenario
from hsr8.scenario.track import AWAY
from hsr8.show.plan_view import PlanView
from hsr8.world.field.generator import draw_layout
from vision.color import COLOR_CLASSES


def test_every_object_is_drawn_in_its_color():
    layout = draw_layout(load_scenario("course"), 1)
    image = PlanView(layout, 0.12, 600).draw()
    assert max(image.shape[:2]) == 600
    for color in {o.color for o in layout.obstacles} | {b.top for b in layout.beacons}:
        rgb = np.round(255 * np.asarray(COLOR_CLASSES[color].rgb))
        assert (np.abs(image - rgb).max(axis=2) <= 1).sum() > 20


def test_y_points_up_and_x_to_the_right():
    scenario = load_scenario("walk", ["world.obstacle=[{position=[2.0, 1.5], radius=0.2}]"])
    image = PlanView(draw_layout(scenario, 0), 0.12, 600).draw()
    red = np.round(255 * np.asarray(COLOR_CLASSES["red"].rgb))
    rows, columns = np.nonzero(np.abs(image - red).max(axis=2) <= 1)
    assert rows.mean() < 0.3 * image.shape[0]
    assert columns.mean() > 0.7 * image.shape[1]


def test_appearing_movers_and_bumps_are_drawn():
    bump = '{kind="bump",magnitude=0.01,position=[1.5,1.5],radius=0.2}'
    faults = '{kind="mover-appears",start=2.0},' + bump
    usual, faulty = (
        PlanView(draw_layout(load_scenario("quick", [f"fault=[{text}]"]), 2), 0.12, 600).draw()
        for text in ('{kind="mover-appears"}', faults)
    )
    rows, columns = np.nonzero((usual != faulty).any(axis=2))
    there = (rows < 0.3 * len(usual)) & (columns > 0.7 * len(usual))
    assert np.count_nonzero(there) > 50
    moved = draw_layout(load_scenario("quick"), 2).movers[0].position
    gone = draw_layout(load_scenario("quick", [f"fault=[{faults}]"]), 2).movers[0].position
    assert gone[0] - moved[0] == AWAY
