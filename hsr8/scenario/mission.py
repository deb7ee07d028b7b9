"""What the robot is asked to do."""

from typing import Annotated, Literal

from annotated_types import Interval, Len
from pydantic import Field

from hsr8.scenario.section import Degrees, LengthRange, Point, Section


class Tour(Section):
    """Via point after via point until the time is over, as in the paper's experiment."""

    kind: Literal["tour"]
    """An endless tour of drawn via points."""
    via_points: Annotated[int, Interval(ge=2, le=500)] = 90
    """Via points drawn; after the last comes the first again [1]."""
    leg: LengthRange = (1.2, 3.0)
    """Shortest and longest way from one via point to the next [m]."""


class Course(Section):
    """Some via points, then a goal to arrive at with a posture."""

    kind: Literal["course"]
    """A finite course of drawn points."""
    via_points: Annotated[int, Interval(ge=0, le=50)] = 4
    """Via points before the goal [1]."""
    leg: LengthRange = (1.2, 6.0)
    """Shortest and longest way from one point to the next [m]."""
    goal_heading_deg: Degrees | None = None
    """Heading to arrive with [deg]; drawn if left out."""


class Points(Section):
    """Via points placed by hand."""

    kind: Literal["points"]
    """A list of points."""
    points: Annotated[tuple[Point, ...], Len(1, 500)]
    """Points to pass in this order in W; the last is the goal unless the tour is endless [m]."""
    goal_heading_deg: Degrees | None = None
    """Heading to arrive with [deg]; any will do if left out."""
    endless: bool = False
    """Whether the first point follows the last."""


class Walk(Section):
    """No navigation: the robot walks what the section `command` asks for."""

    kind: Literal["walk"]
    """Walking as commanded."""


Mission = Annotated[Tour | Course | Points | Walk, Field(discriminator="kind")]
