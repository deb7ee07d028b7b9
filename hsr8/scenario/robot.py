"""The robot of a scenario: body, start and speeds."""

from typing import Annotated, Literal

from annotated_types import Interval

from hsr8.scenario.section import Section, Speed
from hsr8.scenario.world import Start


class SpeedEnvelope(Section):
    """Speeds navigation may ask of walking."""

    vx: Speed = 0.20
    """Fastest walk forward [m/s]."""
    vx_backward: Speed = 0.10
    """Fastest walk backward [m/s]."""
    vy: Speed = 0.08
    """Fastest walk sideways [m/s]."""
    wz: Annotated[float, Interval(gt=0.0, le=3.0)] = 0.8
    """Fastest turn [rad/s]."""
    acceleration: Annotated[float, Interval(gt=0.0, le=5.0)] = 0.3
    """Largest change of speed [m/s²]."""


class Robot(Section):
    """Body, start and speeds."""

    body: Literal["full", "kinematic"] = "full"
    """Full physics, or a body without dynamics whose footsteps land where they are planned."""
    start: Start = Start()
    """Where it stands at time zero."""
    speed: SpeedEnvelope = SpeedEnvelope()
    """Speeds navigation may ask of walking."""
