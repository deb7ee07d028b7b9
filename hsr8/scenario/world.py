"""Section ``[world]``: field, obstacles drawn from the seed or placed by hand, beacons, light."""

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

Side = Annotated[float, Interval(ge=0.5, le=100.0), "m"]
Bearing = Annotated[float, Interval(ge=0.0, le=180.0)]
RecordedTime = Annotated[float, Interval(ge=-1e10, le=1e10)]
BearingRange = Annotated[tuple[Bearing, Bearing], AfterValidator(ordered)]

MAX_CYLINDERS = 1000  # of a wall
GAP_RATIO = 5.0 / 6.0  # default gap in a wall, relative to the diameter of the robot [1]


class StaticObstacle(Section):
    """Static obstacle: a cylinder."""

    position: Point
    """Axis of the cylinder in W, x and y [m]."""
    radius: Radius = 0.08
    """Radius [m]."""
    color: Color = "red"
    """Colour; independent of size and motion."""


class _Mover(Section):
    radius: Radius = 0.08
    """Radius [m]."""
    color: Color = "blue"
    """Colour; independent of size and motion."""
    speed: Speed = 0.10
    """Constant speed along the path [m/s]."""


class ShuttleMover(_Mover):
    """Back and forth between two points."""

    motion: Literal["shuttle"]
    start: Point
    """Initial position in W [m]."""
    end: Point
    """Turning point in W [m]."""


class LineMover(_Mover):
    """Straight ahead."""

    motion: Literal["line"]
    start: Point
    """Initial position in W [m]."""
    heading_deg: Degrees
    """Direction of motion, counter-clockwise from x of W [deg]."""


class CircleMover(_Mover):
    """Around a circle."""

    motion: Literal["circle"]
    centre: Point
    """Centre of the circle in W [m]."""
    path_radius: Annotated[float, Interval(gt=0.0, le=50.0), "m"]
    """Radius of the circle [m]."""
    angle_deg: Degrees = 0.0
    """Initial angle on the circle, counter-clockwise from x of W [deg]."""
    clockwise: bool = False
    """Whether the motion is clockwise."""


class Wall(Section):
    """Wall: a row of cylinders with gaps too narrow for the robot."""

    start: Point
    """Axis of the first cylinder in W [m]."""
    end: Point
    """Axis of the last cylinder in W [m]."""
    radius: Radius = 0.12
    """Radius of a cylinder [m]."""
    gap: Annotated[float, Interval(ge=0.0, le=4.0), "m"] | None = None
    """Maximum gap between neighbouring cylinders; default: 5/6 of the robot's diameter [m]."""

    def intervals(self, robot_radius: float) -> int:
        """Number of intervals between the cylinders, for a robot of some radius [m]."""
        length = hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])
        gap = 2.0 * GAP_RATIO * robot_radius if self.gap is None else self.gap
        return ceil(length / max(2.0 * self.radius + gap, 1e-9) - 1e-9)

    def positions(self, robot_radius: float) -> list[Point]:
        """Axes of the cylinders, evenly spaced, for a robot of some radius [m]."""
        (x, y), (dx, dy) = self.start, (self.end[0] - self.start[0], self.end[1] - self.start[1])
        n = self.intervals(robot_radius)
        return [(x + k / n * dx, y + k / n * dy) for k in range(n + 1)] if n else [self.start]


class Encounters(Section):
    """Moving obstacles on collision courses, which cross the field once at constant velocity.

    Each would meet a robot that walks straight from point to point at the nominal pace. None
    reacts to the robot.
    """

    n: Count = 0
    """Number of these moving obstacles, distributed over the nominal walk [1]."""
    speed_ratio: RatioRange = (0.4, 1.0)
    """Minimum and maximum speed relative to `robot.speed.vx` [1]."""
    bearing_deg: BearingRange = (0.0, 90.0)
    """Range of the bearing of approach: 0 ahead, 180 behind, on either side [deg]."""
    pace: Annotated[float, Interval(gt=0.0, le=1.0)] = 0.75
    """Speed of the nominal walk relative to `robot.speed.vx` [1]."""


class TrackMover(Section):
    """Along recorded tracks: one mover for each id of a file that enters the field."""

    motion: Literal["track"]
    file: Annotated[str, Len(1, 1000)]
    """CSV file with the columns t [s], x [m], y [m] and id, next to the scenario or in the working
    folder."""
    data: Annotated[str, Len(0, 8_000_000)] = ""
    """Content of the file, which saved scenarios have; default: read from the file."""
    radius: Radius = 0.08
    """Radius [m]."""
    color: Color | None = None
    """Colour; default: all colours in turn."""
    scale: Annotated[float, Interval(ge=0.001, le=1000.0), "m"] | None = None
    """Length in the world per length in the file; default: 1 [1]."""
    time_scale: Annotated[float, Interval(ge=0.001, le=1000.0), "s"] | None = None
    """Time in the world per time in the file; default: 1 [1]."""
    offset: Point = (0.0, 0.0)
    """Position of the origin of the file in W [m]."""
    start: RecordedTime | None = None
    """Time in the file at the start of the run; default: that of the first sample [s]."""
    latest_start: RecordedTime | None = None
    """The seed draws the start between `start` and this time in the file; default: `start` [s]."""
    end: Literal["leave", "stay", "repeat"] = "leave"
    """Before and after its samples, a mover is absent (leave), or waits and stays there (stay).
    repeat: as leave, and the recording begins again after its end."""


Mover = Annotated[
    ShuttleMover | LineMover | CircleMover | TrackMover, Field(discriminator="motion")
]


class World(Section):
    """Field, obstacles, beacons and light; drawn obstacles are added to those placed by hand."""

    size: tuple[Side, Side] = (5.0, 5.0)
    """Size of the field along x and y of W, centred on the origin [m]."""
    scale: Annotated[float, Interval(ge=0.05, le=20.0), "m"] = 1.0
    """Size of obstacles' heights, beacons, lines and distances relative to those for HSR-VIII
    [1]."""
    n_static: Count = 12
    """Number of drawn static obstacles [1]."""
    n_moving: Count = 4
    """Number of drawn moving obstacles [1]."""
    radius: RadiusRange = (0.05, 0.12)
    """Minimum and maximum radius of a drawn obstacle [m]."""
    speed_ratio: RatioRange = (0.3, 0.7)
    """Minimum and maximum speed of a drawn moving obstacle relative to `robot.speed.vx` [1]."""
    motions: Annotated[tuple[Literal["shuttle", "circle", "wander"], ...], Len(1, 3)] = ("shuttle",)
    """Motions of drawn moving obstacles, with equal probability."""
    lane: LengthRange = (0.8, 1.8)
    """Minimum and maximum length (shuttle), diameter (circle) or extent (wander) of a path [m]."""
    encounters: Encounters = Encounters()
    """Moving obstacles on collision courses."""
    beacons: bool = True
    """Whether the field has six beacons: two-colour landmarks at known places."""
    beacon_displacement: Annotated[float, Interval(ge=-10.0, le=10.0), "m"] = 0.0
    """Displacement of the first beacon from its known place, along the border [m]."""
    brightness: Annotated[float, Interval(ge=0.1, le=2.0)] = 1.0
    """Relative intensity of all lights [1]."""
    obstacle: Annotated[tuple[StaticObstacle, ...], Len(0, 64)] = ()
    """Static obstacles placed by hand."""
    wall: Annotated[tuple[Wall, ...], Len(0, 16)] = ()
    """Walls placed by hand."""
    mover: Annotated[tuple[Mover, ...], Len(0, 64)] = ()
    """Moving obstacles placed by hand."""


class Start(Section):
    """Initial pose of the robot; drawn by default."""

    position: Point | None = None
    """Position in W; default: drawn [m]."""
    heading_deg: Degrees | None = None
    """Heading, counter-clockwise from x of W; default: drawn [deg]."""
