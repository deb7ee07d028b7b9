from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.reference import json_schema
from hsr8.scenario.schema import MAX_SEED
from navigation.parameters.belief import BeliefParameters
from navigation.parameters.navigation import NavigationParameters
from vision.parameters import VisionParameters
from walking.parameters import WalkingParameters

QUICK = load_scenario("quick")


def test_the_defaults_are_those_of_the_libraries():
    scenario = load_scenario("course")
    assert scenario.walking == WalkingParameters()
    assert scenario.vision == VisionParameters()
    assert scenario.belief == BeliefParameters()
    parameters = scenario.navigation
    assert isinstance(parameters, NavigationParameters)
    assert parameters.gaze == NavigationParameters.extended().gaze


def test_the_profile_paper_is_that_of_the_library():
    given = load_scenario("course", ["navigation.profile=paper"]).navigation
    paper = NavigationParameters.paper()
    for name in (
        "mission",
        "evaluation",
        "gaze",
        "planner",
        "univector",
        "safety_filter",
        "velocity_mapping",
    ):
        assert getattr(given, name) == getattr(paper, name)


def test_a_command_lasts_for_one_footstep():
    scenario = load_scenario("course", ["walking.gait.footstep_time=0.4", "robot.speed.vx=0.15"])
    limits = scenario.speed_limits()
    assert limits.footstep == 0.4
    assert limits.vx == 0.15


@given(seed=st.integers(0, MAX_SEED))
def test_any_non_negative_integer_is_a_seed(seed):
    for given_ in (seed, np.int64(seed)):
        drawn = QUICK.with_seed(given_).seed
        assert drawn == seed
        assert type(drawn) is int


@pytest.mark.parametrize("seed", [-1, MAX_SEED + 1, 1.0, "1", np.float64(1.0)])
def test_an_invalid_seed_is_refused(seed):
    with pytest.raises(ScenarioError, match=r"seed=.*expected an integer"):
        QUICK.with_seed(seed)


def test_a_scenario_is_immutable():
    scenario = load_scenario("course")
    with pytest.raises(ValidationError):
        scenario.duration = 1.0
    with pytest.raises(FrozenInstanceError):
        scenario.walking.gait.swing_height = 1.0


def test_every_key_is_explained_and_every_quantity_has_a_unit():
    schema = json_schema()
    for table in (schema, *(d for d in schema["$defs"].values() if "properties" in d)):
        for name, node in table["properties"].items():
            text = node.get("description", "")
            assert text or "$ref" in node or name in ("kind", "motion"), (table["title"], name)
            numeric = node.get("items", node).get("type") in ("number", "integer")
            assert not numeric or text.rstrip(".").endswith("]"), (table["title"], name, text)
