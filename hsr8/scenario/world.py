"""Section ``[world]``: field, obstacles drawn from the seed or placed by hand, beacons, light."""

from math import ceil, hypot
from typing import Annotated, Literal

from annotated_types import Interval, Len, doc
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

    position: Annotated[Point, doc("Axis of the cylinder in W, x and y [m].")]
    radius: Annotated[Radius, doc("Radius [m].")] = 0.08
    color: Annotated[Color, doc("Colour; independent of size and motion.")] = "red"


class _Mover(Section):
    radius: Annotated[Radius, doc("Radius [m].")] = 0.08
    color: Annotated[Color, doc("Colour; independent of size and motion.")] = "blue"
    speed: Annotated[Speed, doc("Constant speed along the path [m/s].")] = 0.10


class ShuttleMover(_Mover):
    """Back and forth between two points."""

    motion: Literal["shuttle"]
    start: Annotated[Point, doc("Initial position in W [m].")]
    end: Annotated[Point, doc("Turning point in W [m].")]


class LineMover(_Mover):
    """Straight ahead."""

    motion: Literal["line"]
    start: Annotated[Point, doc("Initial position in W [m].")]
    heading_deg: Annotated[
        Degrees, doc("Direction of motion, counter-clockwise from x of W [deg].")
    ]


class CircleMover(_Mover):
    """Around a circle."""

    motion: Literal["circle"]
    centre: Annotated[Point, doc("Centre of the circle in W [m].")]
    path_radius: Annotated[float, Interval(gt=0.0, le=50.0), "m", doc("Radius of the circle [m].")]
    angle_deg: Annotated[
        Degrees, doc("Initial angle on the circle, counter-clockwise from x of W [deg].")
    ] = 0.0
    clockwise: Annotated[bool, doc("Whether the motion is clockwise.")] = False


class Wall(Section):
    """Wall: a row of cylinders with gaps too narrow for the robot."""

    start: Annotated[Point, doc("Axis of the first cylinder in W [m].")]
    end: Annotated[Point, doc("Axis of the last cylinder in W [m].")]
    radius: Annotated[Radius, doc("Radius of a cylinder [m].")] = 0.12
    gap: Annotated[
        Annotated[float, Interval(ge=0.0, le=4.0), "m"] | None,
        doc(
            "Maximum gap between neighbouring cylinders; default: 5/6 of the robot's diameter [m]."
        ),
    ] = None

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

    Each would meet a robot that walks straight from point to point at the nominal pace.
    """

    n: Annotated[
        Count, doc("Number of these moving obstacles, distributed over the nominal walk [1].")
    ] = 0
    speed_ratio: Annotated[
        RatioRange, doc("Minimum and maximum speed relative to `robot.speed.vx` [1].")
    ] = (0.4, 1.0)
    bearing_deg: Annotated[
        BearingRange,
        doc("Range of the bearing of approach: 0 ahead, 180 behind, on either side [deg]."),
    ] = (0.0, 90.0)
    pace: Annotated[
        float,
        Interval(gt=0.0, le=1.0),
        doc("Speed of the nominal walk relative to `robot.speed.vx` [1]."),
    ] = 0.75


class CircleCrossing(Section):
    """People who cross a circle, each to the opposite point: the circle crossing of CrowdNav.

    The lengths of CrowdNav, with robot and people of radius 0.3 m and a circle of 4 m, are scaled
    to `robot.radius`; 1 m/s is scaled to `robot.speed.vx`.
    """

    n: Annotated[Count, doc("Number of people [1].")] = 0
    path_radius: Annotated[
        float, Interval(gt=0.0, le=50.0), "m", doc("Radius of the circle around the origin [m].")
    ] = 1.6
    radius: Annotated[Radius, doc("Radius of a person [m].")] = 0.12
    speed_ratio: Annotated[
        float,
        Interval(gt=0.0, le=10.0),
        doc("Preferred speed relative to `robot.speed.vx` [1]."),
    ] = 1.0
    perturbation: Annotated[
        float,
        Interval(ge=0.0, le=50.0),
        "m",
        doc("Width of the uniform perturbation of each start along x and y [m]."),
    ] = 0.4
    gap: Annotated[
        float,
        Interval(ge=0.0, le=50.0),
        "m",
        doc("Minimum distance of a start or goal from other ones and those of the robot [m]."),
    ] = 0.08


class TrackMover(Section):
    """Along recorded tracks: one mover for each id of a file that enters the field."""

    motion: Literal["track"]
    file: Annotated[
        str,
        Len(1, 1000),
        doc(
            "CSV file with the columns t [s], x [m], y [m] and id, next to the scenario or in the "
            "working folder."
        ),
    ]
    data: Annotated[
        str,
        Len(0, 8_000_000),
        doc("Content of the file, which saved scenarios have; default: read from the file."),
    ] = ""
    radius: Annotated[Radius, doc("Radius [m].")] = 0.08
    color: Annotated[Color | None, doc("Colour; default: all colours in turn.")] = None
    scale: Annotated[
        Annotated[float, Interval(ge=0.001, le=1000.0), "m"] | None,
        doc("Length in the world per length in the file; default: 1 [1]."),
    ] = None
    time_scale: Annotated[
        Annotated[float, Interval(ge=0.001, le=1000.0), "s"] | None,
        doc("Time in the world per time in the file; default: 1 [1]."),
    ] = None
    offset: Annotated[Point, doc("Position of the origin of the file in W [m].")] = (0.0, 0.0)
    start: Annotated[
        RecordedTime | None,
        doc("Time in the file at the start of the run; default: that of the first sample [s]."),
    ] = None
    latest_start: Annotated[
        RecordedTime | None,
        doc(
            "The seed draws the start between `start` and this time in the file; default: `start` "
            "[s]."
        ),
    ] = None
    end: Annotated[
        Literal["leave", "stay", "repeat"],
        doc(
            "Before and after its samples, a mover is absent (leave), or waits and stays there "
            "(stay). repeat: as leave, and the recording begins again after its end."
        ),
    ] = "leave"


Mover = Annotated[
    ShuttleMover | LineMover | CircleMover | TrackMover, Field(discriminator="motion")
]


class World(Section):
    """Field, obstacles, beacons and light; drawn obstacles are added to those placed by hand."""

    size: Annotated[
        tuple[Side, Side], doc("Size of the field along x and y of W, centred on the origin [m].")
    ] = (5.0, 5.0)
    scale: Annotated[
        float,
        Interval(ge=0.05, le=20.0),
        "m",
        doc(
            "Size of obstacles' heights, beacons, lines and distances relative to those for "
            "HSR-VIII [1]."
        ),
    ] = 1.0
    n_static: Annotated[Count, doc("Number of drawn static obstacles [1].")] = 12
    n_moving: Annotated[Count, doc("Number of drawn moving obstacles [1].")] = 4
    radius: Annotated[RadiusRange, doc("Minimum and maximum radius of a drawn obstacle [m].")] = (
        0.05,
        0.12,
    )
    height: Annotated[
        LengthRange | None,
        doc(
            "Minimum and maximum height of the obstacles, which the seed draws; default: 0.3 m "
            "times `scale` [m]."
        ),
    ] = None
    speed_ratio: Annotated[
        RatioRange,
        doc(
            "Minimum and maximum speed of a drawn moving obstacle relative to `robot.speed.vx` [1]."
        ),
    ] = (0.3, 0.7)
    motions: Annotated[
        tuple[Literal["shuttle", "circle", "wander"], ...],
        Len(1, 3),
        doc("Motions of drawn moving obstacles, with equal probability."),
    ] = ("shuttle",)
    lane: Annotated[
        LengthRange,
        doc(
            "Minimum and maximum length (shuttle), diameter (circle) or extent (wander) of a path "
            "[m]."
        ),
    ] = (0.8, 1.8)
    encounters: Annotated[Encounters, doc("Moving obstacles on collision courses.")] = Encounters()
    yield_fraction: Annotated[
        float,
        Interval(ge=0.0, le=1.0),
        doc(
            "Fraction of the moving obstacles that slow down and wait while the robot is near and "
            "ahead on their lane [1]."
        ),
    ] = 0.0
    crowd: Annotated[
        Literal["none", "orca"],
        doc(
            "orca: moving obstacles walk to the ends of their lanes and avoid one another, static "
            "obstacles and the robot, a world without a certificate; none: they stay on their "
            "lanes."
        ),
    ] = "none"
    crowd_sees_robot: Annotated[bool, doc("Whether a crowd avoids the robot.")] = True
    circle: Annotated[CircleCrossing, doc("People who cross a circle.")] = CircleCrossing()
    beacons: Annotated[
        bool, doc("Whether the field has six beacons: two-colour landmarks at known places.")
    ] = True
    beacon_displacement: Annotated[
        float,
        Interval(ge=-10.0, le=10.0),
        "m",
        doc("Displacement of the first beacon from its known place, along the border [m]."),
    ] = 0.0
    brightness: Annotated[
        float, Interval(ge=0.1, le=2.0), doc("Relative intensity of all lights [1].")
    ] = 1.0
    obstacle: Annotated[
        tuple[StaticObstacle, ...], Len(0, 64), doc("Static obstacles placed by hand.")
    ] = ()
    wall: Annotated[tuple[Wall, ...], Len(0, 16), doc("Walls placed by hand.")] = ()
    mover: Annotated[tuple[Mover, ...], Len(0, 64), doc("Moving obstacles placed by hand.")] = ()


class Start(Section):
    """Initial pose of the robot; drawn by default."""

    position: Annotated[Point | None, doc("Position in W; default: drawn [m].")] = None
    heading_deg: Annotated[
        Degrees | None, doc("Heading, counter-clockwise from x of W; default: drawn [deg].")
    ] = None
