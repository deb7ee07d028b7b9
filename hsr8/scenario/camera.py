"""Section ``[camera]``: optics, timing and noise of the head camera."""

from math import atan, degrees, radians, tan
from typing import Annotated, Literal

from annotated_types import Interval, MultipleOf
from pydantic import model_validator

from hsr8.scenario.section import CONTROL_PERIOD_MS, PeriodMs, Section

LENSES = {"wide": 70.0, "narrow": 45.0}
"""Vertical field of view of the named lenses [deg]."""

DelayMs = Annotated[int, Interval(ge=0, le=500), MultipleOf(CONTROL_PERIOD_MS)]


class CameraNoise(Section):
    """Image noise."""

    pixel: Annotated[float, Interval(ge=0.0, le=60.0)] = 3.0
    """White noise of each channel of each pixel; rendered images only [grey level]."""
    exposure: Annotated[float, Interval(ge=0.0, le=0.3)] = 0.02
    """White noise of the exposure from image to image, relative; rendered images only [1]."""


class Camera(Section):
    """Head camera; `walking.head` limits its rate, `navigation.gaze` its range."""

    source: Literal["rendered", "analytic", "omnidirectional"] = "rendered"
    """rendered: OpenGL images; analytic: cylinders projected geometrically, without OpenGL;
    omnidirectional: analytic with a 360 deg view, an upper bound for every gaze."""
    width: Annotated[int, Interval(ge=32, le=1920)] = 320
    """Image width [pixel]."""
    height: Annotated[int, Interval(ge=24, le=1080)] = 240
    """Image height [pixel]."""
    lens: Literal["wide", "narrow", "custom"] = "wide"
    """wide: 70 deg vertically (86 deg horizontally at 4:3); narrow: 45 deg (58 deg); custom."""
    vertical_fov_deg: Annotated[float, Interval(ge=10.0, le=120.0)] = LENSES["wide"]
    """Vertical field of view; fixed by the lens unless custom [deg]."""
    period_ms: PeriodMs = 60
    """Frame period, a multiple of the control tick of 5 ms [ms]."""
    latency_ms: DelayMs = 0
    """Latency from exposure to arrival, a multiple of 5 ms [ms]."""
    shutter_ms: Annotated[float, Interval(ge=0.0, le=100.0)] = 0.0
    """Exposure time, at most the frame period; causes motion blur; rendered images only [ms]."""
    shadows: bool = False
    """Whether rendered images have shadows; doubles the rendering time."""
    noise: CameraNoise = CameraNoise()
    """Image noise."""

    @property
    def omnidirectional(self) -> bool:
        """Whether the field of view is 360 deg."""
        return self.source == "omnidirectional"

    @property
    def vertical_fov(self) -> float:
        """Vertical field of view [rad]."""
        return radians(self.vertical_fov_deg)

    @property
    def horizontal_fov_deg(self) -> float:
        """Horizontal field of view [deg]."""
        half = tan(0.5 * self.vertical_fov) * self.width / self.height
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

    @model_validator(mode="after")
    def _exposed_within_a_period(self) -> "Camera":
        if self.shutter_ms > self.period_ms:
            raise ValueError(
                f"shutter_ms = {self.shutter_ms:g} is longer than period_ms = {self.period_ms}: "
                "an image is exposed before the next one is taken"
            )
        return self
