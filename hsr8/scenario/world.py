"""The world a scenario describes: what is drawn from the seed and what is placed by hand."""

from math import ceil, hypot
from typing import Annotated, Literal

from annotated_types import Interval, Len
from pydantic import AfterValidator, Field

from hsr8.scenario.section import (
    Color,
    Count,
    Degrees,
    LengthRange,
    Point,
    Radius,
    RadiusRange,
    RatioRange,
    Section,
    Speed,
    ordered,
)

Side = Annotated[float, Interval(ge=1.0, le=20.0)]
Bearing = Annotated[float, Interval(ge=0.0, le=180.0)]
BearingRange = Annotated[tuple[Bearing, Bearing], AfterValidator(ordered)]

ROBOT_RADIUS = 0.12
"""Radius of the circle in which the walking robot fits, S_robot [m]."""


class StaticObstacle(Section):
    """A cylinder that stands still."""

    position: Point
    """Axis of the cylinder in W, x and y [m]."""
    radius: Radius = 0.08
    """Radius [m]."""
    color: Color = "red"
    """Colour; it says nothing about size or motion."""


class _Mover(Section):
    radius: Radius = 0.08
    """Radius [m]."""
    color: Color = "blue"
    """Colour; it says nothing about size or motion."""
    speed: Speed = 0.10
    """Speed along its lane, constant [m/s]."""


class ShuttleMover(_Mover):
    """A cylinder that goes back and forth between two points and turns about at the ends."""

    motion: Literal["shuttle"]
    """Back and forth."""
    start: Point
    """Where it is at time zero, one end of its lane in W [m]."""
    end: Point
    """Other end of its lane in W [m]."""


class LineMover(_Mover):
    """A cylinder that goes straight on and never turns about."""

    motion: Literal["line"]
    """One way."""
    start: Point
    """Where it is at time zero in W [m]."""
    heading_deg: Degrees
    """Direction in which it goes, counter-clockwise from x of W [deg]."""


class CircleMover(_Mover):
    """A cylinder that goes round a circle."""

    motion: Literal["circle"]
    """Round."""
    centre: Point
    """Centre of the circle in W [m]."""
    path_radius: Annotated[float, Interval(gt=0.0, le=10.0)]
    """Radius of the circle [m]."""
    angle_deg: Degrees = 0.0
    """Where on the circle it is at time zero, counter-clockwise from x of W [deg]."""
    clockwise: bool = False
    """Sense of the motion."""


class Wall(Section):
    """Static cylinders side by side, too close for the robot: a wall that vision knows."""

    start: Point
    """Axis of the first cylinder in W [m]."""
    end: Point
    """Axis of the last cylinder in W [m]."""
    radius: Radius = 0.12
    """Radius of each [m]."""
    gap: Annotated[float, Interval(ge=0.0, lt=2.0 * ROBOT_RADIUS)] = 0.20
    """Widest gap between neighbours, narrower than the robot [m]."""

    def positions(self) -> list[Point]:
        """Axes of the cylinders, evenly spaced [m]."""
        (x, y), (dx, dy) = self.start, (self.end[0] - self.start[0], self.end[1] - self.start[1])
        n = ceil(hypot(dx, dy) / (2.0 * self.radius + self.gap) - 1e-9)
        return [(x + k / n * dx, y + k / n * dy) for k in range(n + 1)] if n else [self.start]


class Encounters(Section):
    """Movers on collision courses: they cross the field once, at constant velocity.

    Each would meet a robot that goes straight from the start through all points at the
    nominal pace. None of them knows where the robot is.
    """

    n: Count = 0
    """Movers to draw, spread over the nominal walk [1]."""
    speed_ratio: RatioRange = (0.4, 1.0)
    """Slowest and fastest, relative to the robot's forward speed `robot.speed.vx` [1]."""
    bearing_deg: BearingRange = (0.0, 90.0)
    """Where the nominal robot sees it come: 0 ahead, 180 behind, either side [deg]."""
    pace: Annotated[float, Interval(gt=0.0, le=1.0)] = 0.75
    """Pace of the nominal walk, relative to the robot's forward speed [1]."""


Mover = Annotated[ShuttleMover | LineMover | CircleMover, Field(discriminator="motion")]


class World(Section):
    """Field, obstacles and light. Drawn obstacles join those placed by hand."""

    size: tuple[Side, Side] = (5.0, 5.0)
    """Extent of the field along x and y of W, centred on the origin [m]."""
    n_static: Count = 12
    """Static obstacles to draw [1]."""
    n_moving: Count = 4
    """Moving obstacles to draw [1]."""
    radius: RadiusRange = (0.05, 0.12)
    """Smallest and largest radius of a drawn obstacle [m]."""
    speed_ratio: RatioRange = (0.3, 0.7)
    """Slowest and fastest drawn mover, relative to the robot's forward speed [1]."""
    motions: Annotated[tuple[Literal["shuttle", "circle", "wander"], ...], Len(1, 3)] = ("shuttle",)
    """Motions drawn for movers, each as likely as the other."""
    lane: LengthRange = (0.8, 1.8)
    """Range of a drawn mover's lane length (shuttle), diameter (circle) or extent (wander) [m]."""
    encounters: Encounters = Encounters()
    """Further movers, on collision courses with the nominal walk."""
    beacons: bool = True
    """Whether the six beacons stand around the field."""
    beacon_displacement: Annotated[float, Interval(ge=-2.0, le=2.0)] = 0.0
    """Distance along the rim at which the first beacon stands from where it is known to [m]."""
    brightness: Annotated[float, Interval(ge=0.1, le=2.0)] = 1.0
    """Strength of all lights, relative to the usual [1]."""
    obstacle: Annotated[tuple[StaticObstacle, ...], Len(0, 64)] = ()
    """Static obstacles placed by hand."""
    wall: Annotated[tuple[Wall, ...], Len(0, 16)] = ()
    """Walls of static cylinders placed by hand."""
    mover: Annotated[tuple[Mover, ...], Len(0, 64)] = ()
    """Moving obstacles placed by hand."""


class Start(Section):
    """Where the robot stands at time zero; what is left out is drawn."""

    position: Point | None = None
    """In W, x and y [m]; drawn if left out."""
    heading_deg: Degrees | None = None
    """Counter-clockwise from x of W [deg]; drawn if left out."""
