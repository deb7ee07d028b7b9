"""Sections ``[mission]`` and ``[command]``: via points and goal, or velocities and footsteps."""

from typing import Annotated, Literal

from annotated_types import Interval, Len, doc
from pydantic import AfterValidator, Field, model_validator

from hsr8.scenario.section import Degrees, LengthRange, Point, Section, ordered


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


Velocity = Annotated[float, Interval(ge=-5.0, le=5.0), "m/s"]
TurnRate = Annotated[float, Interval(ge=-10.0, le=10.0), "rad/s"]
Fraction = Annotated[float, Interval(ge=0.0, le=1.0)]
Seconds = Annotated[float, Interval(ge=0.005, le=7200.0), "s"]
VelocityRange = Annotated[tuple[Velocity, Velocity], AfterValidator(ordered)]
TurnRange = Annotated[tuple[TurnRate, TurnRate], AfterValidator(ordered)]
SecondsRange = Annotated[tuple[Seconds, Seconds], AfterValidator(ordered)]


class Footsteps(Section):
    """Explicit footsteps, all alike: the command state of the walking pattern."""

    # Times of the pendulum, √(height / g), hence √m.
    single_support: Annotated[
        float, Interval(gt=0.0, le=2.0), "m^0.5", doc("Duration of the single support [s].")
    ] = 0.27
    double_support: Annotated[
        float,
        Interval(gt=0.0, le=2.0),
        "m^0.5",
        doc("Duration of the preceding double support [s]."),
    ] = 0.07
    forward: Annotated[
        float, Interval(ge=-2.0, le=2.0), "m", doc("Advance of the stance centre per footstep [m].")
    ] = 0.0
    side: Annotated[
        float, Interval(gt=0.0, le=2.0), "m", doc("Distance between the feet at landing [m].")
    ] = 0.084
    direction: Annotated[
        float,
        Interval(ge=-1.5, le=1.5),
        doc(
            "Yaw of the landing foot relative to the support foot, counter-clockwise positive "
            "[rad]."
        ),
    ] = 0.0
    swing_height: Annotated[
        float, Interval(gt=0.0, le=1.0), "m", doc("Maximum height of the swing foot [m].")
    ] = 0.025


class Stretch(Section):
    """Constant velocity, or footsteps all alike, for a time."""

    duration: Annotated[float, Interval(gt=0.0, le=7200.0), "s", doc("Duration [s].")]
    vx: Annotated[Velocity, doc("Forward velocity [m/s].")] = 0.0
    vy: Annotated[Velocity, doc("Lateral velocity, to the left positive [m/s].")] = 0.0
    wz: Annotated[TurnRate, doc("Turn rate, counter-clockwise positive [rad/s].")] = 0.0
    footstep: Annotated[Footsteps | None, doc("Explicit footsteps, instead of a velocity.")] = None

    @model_validator(mode="after")
    def _one_of_both(self) -> "Stretch":
        if self.footstep is not None and (self.vx, self.vy, self.wz) != (0.0, 0.0, 0.0):
            raise ValueError("expected a velocity (vx, vy, wz) or a footstep, not both")
        return self


class RandomCommands(Section):
    """Velocities drawn from the seed, each held for a drawn time."""

    vx: Annotated[VelocityRange, doc("Minimum and maximum forward velocity [m/s].")] = (-0.4, 0.4)
    vy: Annotated[VelocityRange, doc("Minimum and maximum lateral velocity [m/s].")] = (-0.15, 0.15)
    wz: Annotated[TurnRange, doc("Minimum and maximum turn rate [rad/s].")] = (-2.0, 2.0)
    interval: Annotated[SecondsRange, doc("Minimum and maximum hold time of a velocity [s].")] = (
        0.5,
        2.0,
    )
    stop_fraction: Annotated[Fraction, doc("Probability that a drawn velocity is zero [1].")] = 0.15


class Command(Section):
    """Velocities or footsteps of a mission of kind "walk".

    A constant velocity or footstep takes precedence over `random`, which does over `stretch`.
    """

    vx: Annotated[Velocity | None, doc("Forward velocity for the whole run [m/s].")] = None
    vy: Annotated[
        Velocity | None, doc("Lateral velocity for the whole run, to the left positive [m/s].")
    ] = None
    wz: Annotated[
        TurnRate | None, doc("Turn rate for the whole run, counter-clockwise positive [rad/s].")
    ] = None
    footstep: Annotated[Footsteps | None, doc("Explicit footsteps for the whole run.")] = None
    random: Annotated[RandomCommands | None, doc("Velocities drawn from the seed.")] = None
    stretch: Annotated[
        tuple[Stretch, ...],
        Len(0, 1000),
        doc("Consecutive velocities or footsteps; after the last one the robot stands."),
    ] = ()

    @model_validator(mode="after")
    def _one_of_both(self) -> "Command":
        if self.footstep is not None and self.constant:
            raise ValueError("expected a velocity (vx, vy, wz) or a footstep, not both")
        return self

    @property
    def constant(self) -> bool:
        """Whether the velocity is constant for the whole run."""
        return any(v is not None for v in (self.vx, self.vy, self.wz))

    @property
    def empty(self) -> bool:
        """Whether no command is given."""
        given = self.constant or self.footstep is not None or self.random is not None
        return not given and not self.stretch
