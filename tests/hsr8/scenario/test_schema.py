from dataclasses import FrozenInstanceError, dataclass, field
from typing import Annotated, Literal

import numpy as np
import pytest
from annotated_types import Gt
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import MAX_SEED
from hsr8.scenario.section import Section
from navigation.parameters.belief import BeliefParameters
from navigation.parameters.navigation import NavigationParameters
from vision.parameters import VisionParameters
from walking.parameters import WalkingParameters

QUICK = load_scenario("quick")


@dataclass(frozen=True)
class Inner:
    """Inner table."""

    length: Annotated[float, Gt(0.0)] = 1.0
    """A length [m]."""


@dataclass(frozen=True)
class Outer:
    """Outer table."""

    inner: Inner = field(default_factory=Inner)
    """A table in a table."""
    mode: Literal["a", "b"] = "a"
    """A choice."""


class Holder(Section):
    """A section with a library's parameters."""

    outer: Outer = Outer()
    """Parameters."""


def test_parameter_dataclasses_are_sections():
    holder = Holder.model_validate_json('{"outer": {"inner": {"length": 2}, "mode": "b"}}')
    assert holder.outer == Outer(Inner(2.0), "b")
    schema = Holder.model_json_schema()["$defs"]["Inner"]
    assert schema["additionalProperties"] is False


@pytest.mark.parametrize(
    "text",
    [
        '{"outer": {"inner": {"length": 0}}}',
        '{"outer": {"inner": {"length": "1"}}}',
        '{"outer": {"inner": {"width": 1}}}',
        '{"outer": {"mode": "c"}}',
        '{"outer": {"inner": {"length": NaN}}}',
    ],
)
def test_their_constraints_hold(text):
    with pytest.raises(ValidationError):
        Holder.model_validate_json(text)


def test_a_scenario_holds_the_libraries_own_parameters():
    scenario = load_scenario("course")
    assert scenario.walking == WalkingParameters()
    assert scenario.vision == VisionParameters()
    assert scenario.belief == BeliefParameters()
    parameters = scenario.navigation
    assert isinstance(parameters, NavigationParameters)
    assert parameters.gaze == NavigationParameters.extended().gaze


def test_the_profile_paper_is_the_librarys():
    given = load_scenario("course", ["navigation.profile=paper"]).navigation
    paper = NavigationParameters.paper()
    for name in (
        "mission",
        "evaluation",
        "gaze",
        "univector",
        "moving_obstacles",
        "unseen_ground",
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
def test_any_whole_number_is_a_seed(seed):
    for given_ in (seed, np.int64(seed)):
        found = QUICK.with_seed(given_).seed
        assert found == seed
        assert type(found) is int


@pytest.mark.parametrize("seed", [-1, MAX_SEED + 1, 1.0, "1", np.float64(1.0)])
def test_what_is_no_seed_is_refused(seed):
    with pytest.raises(ScenarioError, match=r"seed=.*expected an integer"):
        QUICK.with_seed(seed)


def test_a_scenario_does_not_change():
    scenario = load_scenario("course")
    with pytest.raises(ValidationError):
        scenario.duration = 1.0
    with pytest.raises(FrozenInstanceError):
        scenario.walking.gait.swing_height = 1.0
