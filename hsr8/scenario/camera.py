"""The head camera of a scenario: optics, timing, noise and faults."""

from math import atan, degrees, radians, tan
from typing import Annotated, Literal

from annotated_types import Interval, Len, MultipleOf
from pydantic import model_validator

from hsr8.scenario.section import CONTROL_PERIOD_MS, PeriodMs, Section

LENSES = {"wide": 70.0, "narrow": 45.0}
"""Vertical field of view of the named lenses [deg]."""

Share = Annotated[float, Interval(ge=0.0, le=1.0)]
Instant = Annotated[float, Interval(ge=0.0, le=7200.0)]
DelayMs = Annotated[int, Interval(ge=0, le=500), MultipleOf(CONTROL_PERIOD_MS)]


class CameraNoise(Section):
    """What is wrong with every image; missed and false blobs are faults and off as a rule."""

    pixel: Annotated[float, Interval(ge=0.0, le=60.0)] = 3.0
    """White noise of each channel of each pixel; of rendered images [grey level]."""
    exposure: Annotated[float, Interval(ge=0.0, le=0.3)] = 0.02
    """White noise of the brightness from image to image, relative; of rendered images [1]."""
    dropped: Share = 0.0
    """Share of images that never arrive [1]."""
    missed: Share = 0.0
    """Share of obstacles and beacons that an image does not show though they are there [1]."""
    false_blobs: Annotated[float, Interval(ge=0.0, le=20.0)] = 0.0
    """Mean number of things that an image shows though they are not there [1]."""


class Blackout(Section):
    """A time during which images are black."""

    start: Instant
    """First moment [s]."""
    duration: Annotated[float, Interval(gt=0.0, le=7200.0)] = 1.0
    """How long [s]."""


class BrightnessStep(Section):
    """A sudden change of all lights; of rendered images."""

    time: Instant
    """When; the change stays until the next one [s]."""
    factor: Annotated[float, Interval(ge=0.05, le=4.0)]
    """Strength of all lights from then on, relative to world.brightness [1]."""


class Camera(Section):
    """The head camera; walking.head limits how fast it turns, navigation.gaze how far."""

    source: Literal["egl", "analytic", "all-round"] = "egl"
    """egl: rendered pixels; analytic: cylinders projected geometrically (needs no OpenGL);
    all-round: the same, of everything around at once. No camera is: an upper bound of gazes."""
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
    latency_ms: DelayMs = 0
    """Time from the capture of an image to its arrival, a multiple of 5 ms [ms]."""
    shadows: bool = False
    """Whether things cast shadows in rendered images, which then take twice as long."""
    noise: CameraNoise = CameraNoise()
    """Noise and random faults of the images."""
    blackout: Annotated[tuple[Blackout, ...], Len(0, 64)] = ()
    """Times during which images are black."""
    brightness_step: Annotated[tuple[BrightnessStep, ...], Len(0, 64)] = ()
    """Sudden changes of the light."""

    @property
    def all_round(self) -> bool:
        """Whether it sees everything around at once."""
        return self.source == "all-round"

    @property
    def horizontal_fov_deg(self) -> float:
        """Horizontal field of view [deg]."""
        half = tan(0.5 * radians(self.vertical_fov_deg)) * self.width / self.height
        return degrees(2.0 * atan(half))

    def black(self, time: float) -> bool:
        """Whether an image taken at `time` [s] is black."""
        return any(b.start <= time < b.start + b.duration for b in self.blackout)

    def light(self, time: float) -> float:
        """Strength of the lights at `time` [s], relative to world.brightness."""
        begun = [step for step in self.brightness_step if step.time <= time]
        return max(begun, key=lambda step: step.time).factor if begun else 1.0

    @model_validator(mode="after")
    def _fov_fits_lens(self) -> "Camera":
        expected = LENSES.get(self.lens, self.vertical_fov_deg)
        if expected != self.vertical_fov_deg:
            raise ValueError(
                f"lens = {self.lens!r} has a vertical_fov_deg of {expected:g}, not "
                f"{self.vertical_fov_deg:g}; set lens = 'custom' to choose it freely"
            )
        return self
