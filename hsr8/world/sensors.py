"""Sensor noise: what stands between the true state of the body and what the robot feels."""

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.sensor_noise import SensorNoise
from hsr8.world.rotation import quaternion_from_yaw, quaternion_product, small_rotation
from walking.sensing import BodySensors

Array = NDArray[np.float64]

BLOCK = 200  # readings whose errors are drawn at a time


class SensorSuite:
    """Adds seeded noise to true readings; one instance a run.

    Args:
        noise: magnitudes.
        rng: generator of this subsystem.
        period: control tick [s].
    """

    def __init__(self, noise: SensorNoise, rng: np.random.Generator, period: float) -> None:
        self._noise = noise
        self._rng = rng
        self._drift_step = noise.yaw_drift * float(np.sqrt(period))
        self._bias_step = noise.gyro_bias * period
        self._yaw_drift = 0.0
        self._gain = 1.0 + noise.foot_force_gain * rng.standard_normal((2, 4))
        widths = (26, 26, 3, 3, 8, 1, 1, 1)
        sigmas = (
            noise.encoder,
            noise.encoder_rate,
            noise.gyro,
            noise.accelerometer,
            noise.foot_force,
            noise.tilt,
            noise.tilt,
            self._drift_step,
        )
        self._sigma = np.repeat(sigmas, widths)
        self._errors = np.zeros((0, len(self._sigma)))  # of the readings to come
        self._read = 0

    def read(
        self,
        *,
        joint_position: Array,
        joint_velocity: Array,
        gyro: Array,
        accelerometer: Array,
        orientation: Array,
        foot_force: Array,
    ) -> BodySensors:
        """Turn true values (units as in ``BodySensors``) into one noisy reading."""
        noise = self._noise
        if self._read == len(self._errors):
            self._errors = self._sigma * self._rng.standard_normal((BLOCK, len(self._sigma)))
            self._read = 0
        error = self._errors[self._read]
        self._read += 1
        roll, pitch, drift = error[66:].tolist()
        self._yaw_drift += drift + self._bias_step
        tilted = quaternion_product(
            orientation, small_rotation(noise.roll_bias + roll, noise.pitch_bias + pitch)
        )
        force = self._gain * foot_force + error[58:66].reshape(2, 4)
        return BodySensors(
            joint_position=joint_position + error[0:26],
            joint_velocity=joint_velocity + error[26:52],
            gyro=gyro + noise.gyro_bias + error[52:55],
            accelerometer=accelerometer + error[55:58],
            orientation=quaternion_product(quaternion_from_yaw(self._yaw_drift), tilted),
            foot_force=np.maximum(force, 0.0),
        )
