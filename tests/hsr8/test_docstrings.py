from dataclasses import dataclass

from hsr8.docstrings import docstrings
from hsr8.scenario.schema import Navigation, Scenario
from navigation.parameters.navigation import NavigationParameters


@dataclass
class Base:
    """A base."""

    length: float = 1.0
    """A length [m]."""
    width: float = 1.0
    """A width [m]."""


class Outer:
    """A class around one: its source is indented."""

    @dataclass
    class Inner(Base):
        """It extends another."""

        width: float = 2.0
        """Its own width,

        in two lines [m].
        """
        silent: int = 0
        count: int = 0

        def doubled(self) -> float:
            """No attribute."""
            return 2.0 * self.width


def test_attributes_have_their_own_docstring_or_that_of_what_is_extended():
    assert docstrings(Base) == {"length": "A length [m].", "width": "A width [m]."}
    assert docstrings(Outer.Inner) == {
        "length": "A length [m].",
        "width": "Its own width,\n\nin two lines [m].",
    }


def test_sections_of_both_kinds_are_described():
    assert docstrings(Scenario)["duration"] == "Maximum simulated time [s]."
    assert docstrings(NavigationParameters).items() < docstrings(Navigation).items()
