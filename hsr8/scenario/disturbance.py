"""Section ``[disturbance]``: random pushes; single pushes are faults."""

from typing import Annotated

from annotated_types import Interval, Len
from pydantic import AfterValidator

from hsr8.robots.description import TRUNK
from hsr8.scenario.command import SecondsRange
from hsr8.scenario.section import Degrees, Section, ordered

PushedBody = Annotated[str, Len(1, 1000)]
PushDuration = Annotated[float, Interval(ge=0.005, le=60.0)]
Impulse = Annotated[float, Interval(gt=0.0, le=1000.0), "N s"]
ImpulseRange = Annotated[tuple[Impulse, Impulse], AfterValidator(ordered)]
DegreesRange = Annotated[tuple[Degrees, Degrees], AfterValidator(ordered)]


class RandomPushes(Section):
    """Consecutive pushes drawn from the seed."""

    start: Annotated[float, Interval(ge=0.0, le=7200.0), "s"] = 3.0
    """Earliest time of the first push [s]."""
    interval: SecondsRange = (2.0, 4.0)
    """Minimum and maximum time between pushes [s]."""
    impulse: ImpulseRange = (0.2, 0.8)
    """Minimum and maximum impulse: force times duration [N s]."""
    duration: PushDuration = 0.05
    """Duration of a push, rounded to control ticks of 5 ms [s]."""
    direction_deg: DegreesRange = (-180.0, 180.0)
    """Range of directions of the force from the robot's heading, counter-clockwise [deg]."""
    body: PushedBody = TRUNK
    """Body that the force acts on; "trunk" is that which carries the arms or the head."""


class Disturbance(Section):
    """Random disturbances; require the full body."""

    random: RandomPushes | None = None
    """Pushes drawn from the seed."""

    @property
    def empty(self) -> bool:
        """Whether no disturbance is given."""
        return self.random is None
