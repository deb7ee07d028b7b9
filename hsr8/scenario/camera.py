"""Section ``[camera]``: optics, timing and noise of the head camera."""

from math import atan, degrees, radians, tan
from typing import Annotated, Literal

from annotated_types import Interval, MultipleOf, doc
from pydantic import model_validator

from hsr8.scenario.section import CONTROL_PERIOD_MS, PeriodMs, Section

IDEAL = {
    "camera": {"vertical_fov_deg": 70.0, "blind_above": 10_000.0},
    "walking": {"head": {"max_rate": 6.0, "max_acceleration": 60.0}},
}
"""Values of the ideal camera and neck; the defaults are those of the realistic camera."""

DelayMs = Annotated[int, Interval(ge=0, le=500), MultipleOf(CONTROL_PERIOD_MS)]


class CameraNoise(Section):
    """Image noise."""

    pixel: Annotated[
        float,
        Interval(ge=0.0, le=60.0),
        doc("White noise of each channel of each pixel; rendered images only [grey level]."),
    ] = 3.0
    exposure: Annotated[
        float,
        Interval(ge=0.0, le=0.3),
        doc("White noise of the exposure from image to image, relative; rendered images only [1]."),
    ] = 0.02


class Camera(Section):
    """Head camera; `walking.head` limits its rate, `navigation.gaze` its range."""

    source: Annotated[
        Literal["rendered", "analytic", "neck-reach", "omnidirectional"],
        doc(
            "rendered: OpenGL images; analytic: cylinders projected geometrically, without "
            "OpenGL; neck-reach: analytic, sees all that the neck could turn to at once, with "
            'gaze.mode "fixed"; omnidirectional: analytic with a 360 deg view. The last two are '
            "bounds for every gaze."
        ),
    ] = "rendered"
    preset: Annotated[
        Literal["realistic", "ideal"],
        doc(
            "realistic: camera and neck like those of small humanoids; ideal: 86 x 70 deg, a neck "
            "of 6 rad/s, every image sharp. Sets vertical_fov_deg, blind_above and walking.head; "
            "other given values, and those of a robot's description, take precedence."
        ),
    ] = "realistic"
    width: Annotated[int, Interval(ge=32, le=1920), doc("Image width [pixel].")] = 320
    height: Annotated[int, Interval(ge=24, le=1080), doc("Image height [pixel].")] = 240
    vertical_fov_deg: Annotated[
        float,
        Interval(ge=10.0, le=120.0),
        doc("Vertical field of view; 46.8 deg are 60 deg horizontally at 4:3 [deg]."),
    ] = 46.8
    blind_above: Annotated[
        float,
        Interval(gt=0.0, le=10_000.0),
        doc("Rate of the camera, by neck and body, above which a frame shows nothing [rad/s]."),
    ] = 0.8
    period_ms: Annotated[
        PeriodMs, doc("Frame period, a multiple of the control tick of 5 ms [ms].")
    ] = 60
    latency_ms: Annotated[
        DelayMs, doc("Latency from exposure to arrival, a multiple of 5 ms [ms].")
    ] = 0
    shutter_ms: Annotated[
        float,
        Interval(ge=0.0, le=100.0),
        doc(
            "Exposure time, at most the frame period; causes motion blur; rendered images only "
            "[ms]."
        ),
    ] = 0.0
    shadows: Annotated[
        bool, doc("Whether rendered images have shadows; doubles the rendering time.")
    ] = False
    noise: Annotated[CameraNoise, doc("Image noise.")] = CameraNoise()

    @property
    def panoramic(self) -> bool:
        """Whether the camera sees in many directions at once."""
        return self.source in ("neck-reach", "omnidirectional")

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
    def _exposed_within_a_period(self) -> "Camera":
        if self.shutter_ms > self.period_ms:
            raise ValueError(
                f"shutter_ms = {self.shutter_ms:g} is longer than period_ms = {self.period_ms}: "
                "an image is exposed before the next one is taken"
            )
        return self
