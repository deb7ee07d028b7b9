"""Sensor suite: noisy readings of encoders, IMU and foot pads."""

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.sensor_noise import SensorNoise
from hsr8.world.body.sensor_kernel import ATTITUDE, FORCE, GYRO, PADS, reading
from walking.sensing import BodySensors

Array = NDArray[np.float64]

BLOCK = 200  # readings per draw of errors


class SensorSuite:
    """Adds seeded noise to true readings; one instance per run.

    Args:
        noise: magnitudes.
        rng: generator of this subsystem.
        period: control tick [s].
        joints: number of joints.
    """

    def __init__(
        self, noise: SensorNoise, rng: np.random.Generator, period: float, joints: int
    ) -> None:
        self._tilt_bias = noise.roll_bias, noise.pitch_bias
        self._gyro_bias = float(noise.gyro_bias)
        self._rng = rng
        self._bias_step = noise.gyro_bias * period
        self._yaw_drift = 0.0  # at the last drawn error
        self._gain = 1.0 + noise.foot_force_gain * rng.standard_normal((2, 4))
        widths = (joints, joints, 3, 3, 8, 1, 1, 1)
        self._joints, self._body = joints, 2 * joints
        sigmas = (
            noise.encoder,
            noise.encoder_rate,
            noise.gyro,
            noise.accelerometer,
            noise.foot_force,
            noise.tilt,
            noise.tilt,
            noise.yaw_drift * float(np.sqrt(period)),
        )
        self._sigma = np.repeat(sigmas, widths)
        self._errors = np.zeros((0, len(self._sigma)))  # of the next readings
        self._next = 0

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
        """Return one noisy reading of true values (units as in ``BodySensors``)."""
        if self._next == len(self._errors):
            self._draw()
        error = self._errors[self._next]
        self._next += 1
        read = reading(
            joint_position,
            joint_velocity,
            gyro,
            accelerometer,
            orientation,
            foot_force,
            error,
            self._gain,
            self._gyro_bias,
        )
        body = read[self._body :]
        return BodySensors(
            joint_position=read[: self._joints],
            joint_velocity=read[self._joints : self._body],
            gyro=body[GYRO:FORCE],
            accelerometer=body[FORCE:PADS],
            orientation=body[ATTITUDE:],
            foot_force=body[PADS:ATTITUDE].reshape(2, 4),
        )

    def _draw(self) -> None:
        """Draw the errors of the next readings."""
        errors = self._sigma * self._rng.standard_normal((BLOCK, len(self._sigma)))
        errors[:, -3:-1] += self._tilt_bias
        steps = errors[:, -1] + self._bias_step
        errors[:, -1] = np.cumsum([self._yaw_drift, *steps])[1:]
        self._yaw_drift = float(errors[-1, -1])
        self._errors, self._next = errors, 0
