"""Sections ``[camera]`` and ``[sensors]``: head camera, noise of encoders, IMU and foot pads."""

from dataclasses import dataclass
from math import radians
from typing import Annotated, Literal

from annotated_types import Ge, Interval, Le, MultipleOf, doc
from pydantic import model_validator

from hsr8.robots.scale import DEFAULT_FOV_DEG
from hsr8.scenario.section import CONTROL_PERIOD_MS, PeriodMs, Section
from vision.camera import PinholeCamera

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
    ] = DEFAULT_FOV_DEG
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
    def pinhole(self) -> PinholeCamera:
        """Intrinsics."""
        return PinholeCamera.from_vertical_fov(self.width, self.height, self.vertical_fov)

    @model_validator(mode="after")
    def _exposed_within_a_period(self) -> "Camera":
        if self.shutter_ms > self.period_ms:
            raise ValueError(
                f"shutter_ms = {self.shutter_ms:g} is longer than period_ms = {self.period_ms}: "
                "an image is exposed before the next one is taken"
            )
        return self


@dataclass(frozen=True)
class SensorNoise:
    """Noise of the joint encoders, the IMU and the foot force sensors."""

    encoder: Annotated[
        float, Ge(0.0), Le(0.02), doc("Standard deviation of each joint encoder [rad].")
    ] = 0.0005
    encoder_rate: Annotated[
        float, Ge(0.0), Le(10.0), doc("Standard deviation of each joint rate [rad/s].")
    ] = 0.02
    gyro: Annotated[
        float, Ge(0.0), Le(1.0), doc("Standard deviation of the gyroscope, per axis [rad/s].")
    ] = 0.01
    accelerometer: Annotated[
        float, Ge(0.0), Le(20.0), doc("Standard deviation of the accelerometer, per axis [m/s²].")
    ] = 0.1
    tilt: Annotated[
        float, Ge(0.0), Le(0.2), doc("Standard deviation of roll and pitch of the IMU [rad].")
    ] = 0.0025
    pitch_bias: Annotated[
        float, Ge(-0.5), Le(0.5), doc("Constant error of the pitch of the IMU [rad].")
    ] = 0.0
    roll_bias: Annotated[
        float, Ge(-0.5), Le(0.5), doc("Constant error of the roll of the IMU [rad].")
    ] = 0.0
    gyro_bias: Annotated[
        float,
        Ge(-1.0),
        Le(1.0),
        doc(
            "Constant error of the gyroscope, per axis; accumulates in the yaw of the IMU [rad/s]."
        ),
    ] = 0.0
    yaw_drift: Annotated[
        float, Ge(0.0), Le(1.0), doc("Random walk of the yaw of the IMU [rad/√s].")
    ] = 0.001
    foot_force: Annotated[
        float, Ge(0.0), Le(50.0), doc("Standard deviation of each foot force sensor [N].")
    ] = 0.2
    foot_force_gain: Annotated[
        float,
        Ge(0.0),
        Le(1.0),
        doc("Standard deviation of the constant gain error of each foot force sensor [1]."),
    ] = 0.05
