"""Section ``[sensors]``: noise of encoders, IMU and foot force sensors."""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le


@dataclass(frozen=True)
class SensorNoise:
    """Noise of the joint encoders, the IMU and the foot force sensors."""

    encoder: Annotated[float, Ge(0.0), Le(0.02)] = 0.0005
    """Standard deviation of each joint encoder [rad]."""
    encoder_rate: Annotated[float, Ge(0.0), Le(10.0)] = 0.02
    """Standard deviation of each joint rate [rad/s]."""
    gyro: Annotated[float, Ge(0.0), Le(1.0)] = 0.01
    """Standard deviation of the gyroscope, per axis [rad/s]."""
    accelerometer: Annotated[float, Ge(0.0), Le(20.0)] = 0.1
    """Standard deviation of the accelerometer, per axis [m/s²]."""
    tilt: Annotated[float, Ge(0.0), Le(0.2)] = 0.0025
    """Standard deviation of roll and pitch of the IMU [rad]."""
    pitch_bias: Annotated[float, Ge(-0.5), Le(0.5)] = 0.0
    """Constant error of the pitch of the IMU [rad]."""
    roll_bias: Annotated[float, Ge(-0.5), Le(0.5)] = 0.0
    """Constant error of the roll of the IMU [rad]."""
    gyro_bias: Annotated[float, Ge(-1.0), Le(1.0)] = 0.0
    """Constant error of the gyroscope, per axis; accumulates in the yaw of the IMU [rad/s]."""
    yaw_drift: Annotated[float, Ge(0.0), Le(1.0)] = 0.001
    """Random walk of the yaw of the IMU [rad/√s]."""
    foot_force: Annotated[float, Ge(0.0), Le(50.0)] = 0.2
    """Standard deviation of each foot force sensor [N]."""
    foot_force_gain: Annotated[float, Ge(0.0), Le(1.0)] = 0.05
    """Standard deviation of the constant gain error of each foot force sensor [1]."""
