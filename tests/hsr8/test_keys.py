from dataclasses import dataclass
from typing import Annotated

from annotated_types import doc

from hsr8.keys import texts
from hsr8.robots.description import RobotDescription
from hsr8.scenario.schema import Navigation, Scenario
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
