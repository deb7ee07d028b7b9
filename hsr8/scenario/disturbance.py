"""What disturbs the robot: pushes, given one by one or drawn."""

from typing import Annotated, Literal

from annotated_types import Interval, Len
from pydantic import AfterValidator, model_validator

from hsr8.scenario.command import SecondsRange
from hsr8.scenario.section import Degrees, Section, ordered

PushedBody = Literal[
    "base_link",
    "torso_link",
    "head_tilt_link",
    "l_knee_link",
    "r_knee_link",
    "l_foot_link",
    "r_foot_link",
]
PushDuration = Annotated[float, Interval(ge=0.005, le=60.0)]
Impulse = Annotated[float, Interval(gt=0.0, le=100.0)]
ImpulseRange = Annotated[tuple[Impulse, Impulse], AfterValidator(ordered)]
DegreesRange = Annotated[tuple[Degrees, Degrees], AfterValidator(ordered)]
Offset = Annotated[float, Interval(ge=-0.5, le=0.5)]


class Push(Section):
    """A constant horizontal force on one body for some time."""

    time: Annotated[float, Interval(ge=0.0, le=7200.0)]
    """When it begins, in whole control ticks of 5 ms [s]."""
    duration: PushDuration = 0.05
    """How long it lasts, in whole control ticks [s]."""
    impulse: Impulse | None = None
    """Force times duration; give this or force [N s]."""
    force: Annotated[float, Interval(gt=0.0, le=1000.0)] | None = None
    """Give this or impulse [N]."""
    direction_deg: Degrees = 90.0
    """Where it pushes to: 0 is the robot's forward when it begins, 90 its left [deg]."""
    body: PushedBody = "torso_link"
    """What is pushed."""
    point: tuple[Offset, Offset, Offset] = (0.0, 0.0, 0.0)
    """Where, from the body's centre of mass, along the body's axes [m]."""

    @model_validator(mode="after")
    def _one_strength(self) -> "Push":
        if (self.impulse is None) == (self.force is None):
            raise ValueError("give either impulse [N s] or force [N]")
        return self


class RandomPushes(Section):
    """Pushes drawn from the seed, one after the other."""

    start: Annotated[float, Interval(ge=0.0, le=7200.0)] = 3.0
    """Nothing is pushed before this time [s]."""
    interval: SecondsRange = (2.0, 4.0)
    """Shortest and longest time from one push to the next [s]."""
    impulse: ImpulseRange = (0.2, 0.8)
    """Weakest and strongest push, force times duration [N s]."""
    duration: PushDuration = 0.05
    """How long each lasts, in whole control ticks of 5 ms [s]."""
    direction_deg: DegreesRange = (-180.0, 180.0)
    """Directions from the robot's forward, counter-clockwise [deg]."""
    body: PushedBody = "torso_link"
    """What is pushed."""


class Disturbance(Section):
    """What disturbs the robot; it needs the full body."""

    push: Annotated[tuple[Push, ...], Len(0, 1000)] = ()
    """Pushes given one by one."""
    random: RandomPushes | None = None
    """Pushes drawn from the seed, besides those."""

    @property
    def empty(self) -> bool:
        """Whether nothing is disturbed."""
        return not self.push and self.random is None
