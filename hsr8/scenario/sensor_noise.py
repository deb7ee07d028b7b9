"""Section ``[sensors]``: noise of encoders, IMU and foot force sensors."""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le, doc


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
