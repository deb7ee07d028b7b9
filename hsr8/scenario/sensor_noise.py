"""How noisy the body's sensors are: a section of the scenario."""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le


@dataclass(frozen=True)
class SensorNoise:
    """Standard deviations and constant errors of the body's sensors."""

    encoder: Annotated[float, Ge(0.0), Le(0.02)] = 0.0005
    """White noise of each joint encoder [rad]."""
    encoder_rate: Annotated[float, Ge(0.0), Le(10.0)] = 0.02
    """White noise of each joint rate [rad/s]."""
    gyro: Annotated[float, Ge(0.0), Le(1.0)] = 0.01
    """White noise of the gyroscope, per axis [rad/s]."""
    accelerometer: Annotated[float, Ge(0.0), Le(20.0)] = 0.1
    """White noise of the accelerometer, per axis [m/s²]."""
    tilt: Annotated[float, Ge(0.0), Le(0.2)] = 0.0025
    """White noise of roll and pitch as the IMU reports them [rad]."""
    pitch_bias: Annotated[float, Ge(-0.5), Le(0.5)] = 0.0
    """Constant error of the pitch that the IMU reports [rad]."""
    roll_bias: Annotated[float, Ge(-0.5), Le(0.5)] = 0.0
    """Constant error of the roll that it reports [rad]."""
    gyro_bias: Annotated[float, Ge(-1.0), Le(1.0)] = 0.0
    """Constant error of the gyroscope about each axis; the IMU's yaw turns away with it [rad/s]."""
    yaw_drift: Annotated[float, Ge(0.0), Le(1.0)] = 0.001
    """Random walk of the IMU's yaw [rad/√s]."""
    foot_force: Annotated[float, Ge(0.0), Le(50.0)] = 0.2
    """White noise of each foot pad [N]."""
    foot_force_gain: Annotated[float, Ge(0.0), Le(1.0)] = 0.05
    """Constant gain error of each foot pad, drawn once a run [1]."""
