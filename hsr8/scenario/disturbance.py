"""Section ``[disturbance]``: random pushes; single pushes are faults."""

from typing import Annotated

from annotated_types import Interval, Len, doc
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

    start: Annotated[
        float, Interval(ge=0.0, le=7200.0), "s", doc("Earliest time of the first push [s].")
    ] = 3.0
    interval: Annotated[SecondsRange, doc("Minimum and maximum time between pushes [s].")] = (
        2.0,
        4.0,
    )
    impulse: Annotated[
        ImpulseRange, doc("Minimum and maximum impulse: force times duration [N s].")
    ] = (0.2, 0.8)
    duration: Annotated[
        PushDuration, doc("Duration of a push, rounded to control ticks of 5 ms [s].")
    ] = 0.05
    direction_deg: Annotated[
        DegreesRange,
        doc("Range of directions of the force from the robot's heading, counter-clockwise [deg]."),
    ] = (-180.0, 180.0)
    body: Annotated[
        PushedBody,
        doc('Body that the force acts on; "trunk" is that which carries the arms or the head.'),
    ] = TRUNK


class Disturbance(Section):
    """Random disturbances; require the full body."""

    random: Annotated[RandomPushes | None, doc("Pushes drawn from the seed.")] = None

    @property
    def empty(self) -> bool:
        """Whether no disturbance is given."""
        return self.random is None
