"""Section ``[robot]``: body, initial pose and speed limits."""

from typing import Annotated, Literal

from annotated_types import Interval, Len, doc

from hsr8.scenario.section import Radius, Section
from hsr8.scenario.world import Start

NOMINAL_SPEED = 0.20
"""Maximum forward speed of HSR-VIII, by which the times of worlds scale [m/s]."""

WalkingSpeed = Annotated[float, Interval(ge=0.01, le=5.0), "m/s"]


class SpeedEnvelope(Section):
    """Speed limits of navigation."""

    vx: Annotated[WalkingSpeed, doc("Maximum forward speed [m/s].")] = NOMINAL_SPEED
    vx_backward: Annotated[WalkingSpeed, doc("Maximum backward speed [m/s].")] = 0.10
    vy: Annotated[WalkingSpeed, doc("Maximum sideways speed [m/s].")] = 0.08
    wz: Annotated[float, Interval(ge=0.01, le=10.0), "rad/s", doc("Maximum turn rate [rad/s].")] = (
        0.8
    )
    acceleration: Annotated[
        float, Interval(ge=0.005, le=20.0), "m/s²", doc("Maximum acceleration [m/s²].")
    ] = 0.3


class Robot(Section):
    """Body, initial pose and speed limits."""

    model: Annotated[
        str,
        Len(1, 1000),
        doc(
            "Robot: a shipped name or the file of a description, next to the scenario or in the "
            "working folder."
        ),
    ] = "hsr8"
    body: Annotated[
        Literal["full", "kinematic"],
        doc("full: MuJoCo physics; kinematic: no dynamics, every footstep lands as planned."),
    ] = "full"
    radius: Annotated[
        Radius,
        doc("Radius of the walking robot, for worlds, their certificates and navigation [m]."),
    ] = 0.12
    start: Annotated[Start, doc("Initial pose.")] = Start()
    speed: Annotated[SpeedEnvelope, doc("Speed limits of navigation.")] = SpeedEnvelope()
