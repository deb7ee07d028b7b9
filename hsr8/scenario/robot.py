"""The robot of a scenario: body, speeds, head camera."""

from math import atan, degrees, radians, tan
from typing import Annotated, Literal

from annotated_types import Interval
from pydantic import model_validator

from hsr8.scenario.section import PeriodMs, Section, Speed
from hsr8.scenario.world import Start

LENSES = {"wide": 70.0, "narrow": 45.0}
"""Vertical field of view of the named lenses [deg]."""


class SpeedEnvelope(Section):
    """Speeds navigation may ask of walking."""

    forward: Speed = 0.20
    """Fastest walk forward [m/s]."""
    backward: Speed = 0.10
    """Fastest walk backward [m/s]."""
    lateral: Speed = 0.08
    """Fastest walk sideways [m/s]."""
    turn: Annotated[float, Interval(gt=0.0, le=3.0)] = 0.8
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


class Camera(Section):
    """The head camera."""

    source: Literal["egl", "analytic"] = "egl"
    """Rendered pixels, or cylinders projected geometrically (needs no OpenGL)."""
    width: Annotated[int, Interval(ge=32, le=1920)] = 320
    """Image width [pixel]."""
    height: Annotated[int, Interval(ge=24, le=1080)] = 240
    """Image height [pixel]."""
    lens: Literal["wide", "narrow", "custom"] = "wide"
    """wide: 70 deg vertically (86 horizontally at 4:3); narrow: 45 (58); custom: as given."""
    vertical_fov_deg: Annotated[float, Interval(ge=10.0, le=120.0)] = LENSES["wide"]
    """Vertical field of view; given by the lens unless that is custom [deg]."""
    period_ms: PeriodMs = 60
    """Time between two images, a multiple of the control tick of 5 ms [ms]."""

    @property
    def horizontal_fov_deg(self) -> float:
        """Horizontal field of view [deg]."""
        half = tan(0.5 * radians(self.vertical_fov_deg)) * self.width / self.height
        return degrees(2.0 * atan(half))

    @model_validator(mode="after")
    def _fov_fits_lens(self) -> "Camera":
        expected = LENSES.get(self.lens, self.vertical_fov_deg)
        if expected != self.vertical_fov_deg:
            raise ValueError(
                f"lens = {self.lens!r} has a vertical_fov_deg of {expected:g}, not "
                f"{self.vertical_fov_deg:g}; set lens = 'custom' to choose it freely"
            )
        return self
