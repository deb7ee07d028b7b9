from dataclasses import dataclass
from typing import Annotated

from annotated_types import doc
from hypothesis import given
from hypothesis import strategies as st

from hsr8.keys import annotation_at, chosen, texts
from hsr8.robots.file.description import Name, RobotDescription, SoleRectangle
from hsr8.scenario.mission import Stretch, Walk
from hsr8.scenario.schema import Navigation, Scenario
from hsr8.seeds import named_rng
from hsr8.suggestion import suggestion
from navigation.parameters.navigation import NavigationParameters

Length = Annotated[float, "m", doc("A length [m].")]


@dataclass
class Base:
    """A base."""

    length: Length = 1.0
    width: Length = 1.0


@dataclass
class Inner(Base):
    """It extends another."""

    width: Annotated[Length, doc("Its own width [m].")] = 2.0
    silent: Annotated[int, "m"] = 0
    count: int = 0


def test_keys_have_their_own_text_or_that_of_the_class_they_extend():
    assert texts(Base) == {"length": "A length [m].", "width": "A length [m]."}
    assert texts(Inner) == {"length": "A length [m].", "width": "Its own width [m]."}


def test_all_kinds_of_tables_are_described():
    assert texts(Scenario)["duration"] == "Maximum simulated time [s]."
    assert texts(NavigationParameters).items() < texts(Navigation).items()
    assert texts(RobotDescription).keys() == RobotDescription.model_fields.keys()


def test_the_annotation_of_a_value_follows_from_the_tables_around_it():
    data = {"mission": {"kind": "walk"}, "command": {"stretch": [{"duration": 1.0}]}}
    assert chosen(annotation_at(("mission",), Scenario, data), data["mission"])[0] is Walk
    assert annotation_at(("mission", "points"), Scenario, data) is None
    assert chosen(annotation_at(("command", "stretch", 0), Scenario, data))[0] is Stretch
    kind, marks = chosen(annotation_at(("command", "stretch", 0, "duration"), Scenario, data))
    assert (kind, "s" in marks) == (float, True)
    for value, expected in (({"front": 1.0}, SoleRectangle), (["a", "b"], tuple[Name, Name])):
        annotation = annotation_at(("sole",), RobotDescription, {"sole": value})
        assert chosen(annotation, value)[0] == expected


def test_the_closest_word_is_suggested():
    assert suggestion("quik", ["paper", "quick"]) == "; did you mean 'quick'?"


def test_nothing_close_is_no_suggestion():
    assert suggestion("zzz", ["paper", "quick"]) == ""
    assert suggestion("quick", []) == ""


@given(st.integers(0, 2**32 - 1))
def test_a_subsystem_draws_the_same_for_the_same_seed(seed):
    assert named_rng(seed, "body").random() == named_rng(seed, "body").random()


@given(st.integers(0, 2**32 - 1))
def test_subsystems_draw_independently(seed):
    draws = {named_rng(seed, name).random() for name in ("body", "camera", "belief")}
    assert len(draws) == 3
