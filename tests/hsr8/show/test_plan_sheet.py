import numpy as np
import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.show.plan_sheet import plan_sheet
from hsr8.show.plan_view import PlanView
from hsr8.world.field.generator import draw_layout


def sheet(size, title="a title"):
    settings = [f"world.size=[{size},{size}]", "world.n_static=1", "world.n_moving=0"]
    return plan_sheet(PlanView(draw_layout(load_scenario("quick", settings), 2), 0.12, 600), title)


def dark(image):
    return image.max(axis=2) < 128


@pytest.mark.parametrize("size", [3.0, 12.0, 40.0])
def test_the_axes_have_numbers_in_fields_of_any_size(size):
    image = dark(sheet(size))
    rows, columns = image.sum(axis=1), image.sum(axis=0)
    left = int(np.flatnonzero(columns > 400)[0])  # the border of the field
    top, bottom = np.flatnonzero(rows > 400)[[0, -1]].tolist()
    margin = image[top + 20 : bottom - 20, : left - 6]
    below = image[bottom + 8 : bottom + 26, left:]
    assert margin[:, left - 20 :].any(axis=1).sum() > 20
    assert not margin[:, 0].any()
    assert below.any(axis=0).sum() > 20


def test_the_title_is_above_and_changes_nothing_else():
    one, other = sheet(4.0), sheet(4.0, "another, longer title")
    changed = np.flatnonzero((one != other).any(axis=(1, 2)))
    assert len(changed)
    assert changed.max() < 45
