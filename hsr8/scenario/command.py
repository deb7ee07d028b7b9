"""What walking is asked for when nobody navigates: velocities or footsteps, given or drawn."""

from typing import Annotated

from annotated_types import Interval, Len
from pydantic import AfterValidator, model_validator

from hsr8.scenario.section import Section, ordered

Velocity = Annotated[float, Interval(ge=-1.0, le=1.0)]
TurnRate = Annotated[float, Interval(ge=-4.0, le=4.0)]
Fraction = Annotated[float, Interval(ge=0.0, le=1.0)]
Seconds = Annotated[float, Interval(ge=0.005, le=7200.0)]
VelocityRange = Annotated[tuple[Velocity, Velocity], AfterValidator(ordered)]
TurnRange = Annotated[tuple[TurnRate, TurnRate], AfterValidator(ordered)]
SecondsRange = Annotated[tuple[Seconds, Seconds], AfterValidator(ordered)]


class Footsteps(Section):
    """Explicit footsteps, one like the other: the command state of the walking pattern."""

    single_support: Annotated[float, Interval(gt=0.0, le=2.0)] = 0.27
    """Time on one foot [s]."""
    double_support: Annotated[float, Interval(gt=0.0, le=2.0)] = 0.07
    """Time on both feet before that [s]."""
    forward: Annotated[float, Interval(ge=-0.5, le=0.5)] = 0.0
    """Advance of the middle of the stance per footstep [m]."""
    side: Annotated[float, Interval(gt=0.0, le=0.5)] = 0.084
    """Distance between the feet at landing [m]."""
    direction: Annotated[float, Interval(ge=-1.5, le=1.5)] = 0.0
    """Of the landing foot, from the support foot, counter-clockwise positive [rad]."""
    swing_height: Annotated[float, Interval(gt=0.0, le=0.2)] = 0.025
    """Height of the swing foot at mid-swing [m]."""


class Stretch(Section):
    """One velocity, or one kind of footstep, for some time."""

    duration: Annotated[float, Interval(gt=0.0, le=7200.0)]
    """How long it is commanded [s]."""
    vx: Velocity = 0.0
    """Velocity forward [m/s]."""
    vy: Velocity = 0.0
    """Velocity to the left [m/s]."""
    wz: TurnRate = 0.0
    """Turn rate, counter-clockwise positive [rad/s]."""
    footstep: Footsteps | None = None
    """Explicit footsteps in place of the velocity."""

    @model_validator(mode="after")
    def _one_of_both(self) -> "Stretch":
        if self.footstep is not None and (self.vx, self.vy, self.wz) != (0.0, 0.0, 0.0):
            raise ValueError("a stretch has a velocity (vx, vy, wz) or a footstep, not both")
        return self


class RandomCommands(Section):
    """Velocities drawn from the seed, each held for some time."""

    vx: VelocityRange = (-0.4, 0.4)
    """Least and greatest velocity forward [m/s]."""
    vy: VelocityRange = (-0.15, 0.15)
    """Least and greatest velocity to the left [m/s]."""
    wz: TurnRange = (-2.0, 2.0)
    """Least and greatest turn rate [rad/s]."""
    interval: SecondsRange = (0.5, 2.0)
    """Shortest and longest time for which a velocity is held [s]."""
    stop_fraction: Fraction = 0.15
    """Share of the draws that are a stop [1]."""


class Command(Section):
    """What walking is asked for in a mission of kind "walk".

    A velocity or a footstep given here holds for the whole run; else velocities are drawn, if
    there is a table of them; else the stretches follow one another.
    """

    vx: Velocity | None = None
    """Velocity forward for the whole run, in place of everything below [m/s]."""
    vy: Velocity | None = None
    """Velocity to the left for the whole run [m/s]."""
    wz: TurnRate | None = None
    """Turn rate for the whole run, counter-clockwise positive [rad/s]."""
    footstep: Footsteps | None = None
    """Explicit footsteps for the whole run."""
    random: RandomCommands | None = None
    """Velocities drawn from the seed."""
    stretch: Annotated[tuple[Stretch, ...], Len(0, 1000)] = ()
    """Velocities or footsteps one after the other; after the last the robot stands."""

    @model_validator(mode="after")
    def _one_of_both(self) -> "Command":
        if self.footstep is not None and self.constant:
            raise ValueError("give a velocity (vx, vy, wz) or a footstep for the run, not both")
        return self

    @property
    def constant(self) -> bool:
        """Whether one velocity holds for the whole run."""
        return any(v is not None for v in (self.vx, self.vy, self.wz))

    @property
    def empty(self) -> bool:
        """Whether nothing is asked."""
        given = self.constant or self.footstep is not None or self.random is not None
        return not given and not self.stretch
