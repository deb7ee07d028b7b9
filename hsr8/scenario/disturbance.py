"""What disturbs the robot: pushes drawn from the seed. Those given one by one are faults."""

from typing import Annotated, Literal

from annotated_types import Interval
from pydantic import AfterValidator

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

    random: RandomPushes | None = None
    """Pushes drawn from the seed."""

    @property
    def empty(self) -> bool:
        """Whether nothing is disturbed."""
        return self.random is None
