import ast
from dataclasses import fields, is_dataclass
from itertools import pairwise
from pathlib import Path

import pytest

from navigation.parameters import belief, gaze, motion, navigation, planner
from navigation.parameters.navigation import NavigationParameters

EXTENDED, PAPER = NavigationParameters.extended(), NavigationParameters.paper()


def test_the_constants_printed_in_the_paper_are_kept():
    assert (PAPER.evaluation.d_nm, PAPER.evaluation.d_fm) == (0.30, 1.30)
    assert PAPER.evaluation.lambda_cf == 0.85
    assert (PAPER.univector.w_muf, PAPER.univector.w_auf) == (0.75, 0.25)


@pytest.mark.parametrize("p", [EXTENDED, PAPER])
def test_weights_of_the_gaze_map_sum_to_one(p):
    g = p.gaze
    assert g.w_lm + g.w_way + g.w_sf + g.w_ob == pytest.approx(1.0)


def test_the_paper_has_none_of_our_additions():
    assert not PAPER.safety_filter.enabled
    assert not PAPER.unseen_ground.enabled
    assert PAPER.gaze.mode == "integrated"
    assert PAPER.moving_obstacles.virtual_obstacle == "printed"
    assert PAPER.univector.blend == "weights"


def test_profiles_share_what_no_switch_names():
    assert PAPER.mission == EXTENDED.mission
    assert PAPER.velocity_mapping == EXTENDED.velocity_mapping
    assert PAPER.moving_obstacles.xi == EXTENDED.moving_obstacles.xi


@pytest.mark.parametrize("module", [belief, gaze, motion, navigation, planner])
def test_every_parameter_has_a_docstring_with_a_unit_or_is_a_choice(module):
    tree = ast.parse(Path(module.__file__).read_text())
    for group in (n for n in tree.body if isinstance(n, ast.ClassDef)):
        body = group.body
        for here, after in pairwise(body):
            if isinstance(here, ast.AnnAssign):
                name = f"{group.name}.{ast.unparse(here.target)}"
                assert isinstance(after, ast.Expr), name
                text = ast.literal_eval(after.value)
                kind = ast.unparse(here.annotation)
                assert (
                    "[" in text
                    or "Literal" in kind
                    or kind in {"bool", "GazeMode", "Method"}
                    or "Parameters" in kind
                ), name


def test_groups_are_frozen_dataclasses():
    for group in fields(EXTENDED):
        value = getattr(EXTENDED, group.name)
        assert is_dataclass(value)
        assert type(value).__dataclass_params__.frozen
