"""Section ``[mission]``: via points and goal."""

from typing import Annotated, Literal

from annotated_types import Interval, Len, doc
from pydantic import Field

from hsr8.scenario.section import Degrees, LengthRange, Point, Section


class Tour(Section):
    """Endless tour of drawn via points, as in the paper's experiment."""

    kind: Literal["tour"]
    via_points: Annotated[
        int,
        Interval(ge=2, le=500),
        doc("Number of via points; after the last, the tour starts again [1]."),
    ] = 90
    leg: Annotated[
        LengthRange, doc("Minimum and maximum distance between consecutive points [m].")
    ] = (1.2, 3.0)


class Course(Section):
    """Drawn via points, then a goal with an arrival heading."""

    kind: Literal["course"]
    via_points: Annotated[
        int, Interval(ge=0, le=50), doc("Number of via points before the goal [1].")
    ] = 4
    leg: Annotated[
        LengthRange, doc("Minimum and maximum distance between consecutive points [m].")
    ] = (1.2, 6.0)
    goal_heading_deg: Annotated[
        Degrees | None, doc("Arrival heading at the goal; default: drawn [deg].")
    ] = None


class Points(Section):
    """Via points placed by hand; the last is the goal unless `endless`."""

    kind: Literal["points"]
    points: Annotated[
        tuple[Point, ...], Len(1, 500), doc("Points in W, in the order of the visits [m].")
    ]
    goal_heading_deg: Annotated[
        Degrees | None, doc("Arrival heading at the goal; default: any [deg].")
    ] = None
    endless: Annotated[bool, doc("Whether the tour starts again after the last point.")] = False


class Walk(Section):
    """No navigation: the robot follows the section `command`."""

    kind: Literal["walk"]


Mission = Annotated[Tour | Course | Points | Walk, Field(discriminator="kind")]
