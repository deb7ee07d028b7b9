"""Sensor suite: noisy readings of encoders, IMU and foot pads."""

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from hsr8.scenario.sensor_noise import SensorNoise
from hsr8.world.rotation import product
from walking.sensing import BodySensors

Array = NDArray[np.float64]

BLOCK = 200  # readings per draw of errors

GYRO, FORCE, PADS, ATTITUDE, WIDTH = 0, 3, 6, 14, 18  # columns after those of the joints


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


@compiled
def reading(
    joint_position: Array,
    joint_velocity: Array,
    gyro: Array,
    accelerometer: Array,
    orientation: Array,
    foot_force: Array,
    error: Array,
    gain: Array,
    gyro_bias: float,
) -> Array:
    """Return one noisy reading (2 n + `WIDTH`,) of true values.

    Args:
        joint_position: true angles (n,) [rad].
        joint_velocity: true rates (n,) [rad/s].
        gyro: true turn rates (3,) [rad/s].
        accelerometer: true specific force (3,) [m/s²].
        orientation: true attitude, quaternion w-x-y-z (4,).
        foot_force: true normal force under each pad (2, 4) [N].
        error: to add (2 n + 17,).
        gain: factor on each foot force (2, 4) [1].
        gyro_bias: constant error of the turn rates [rad/s].
    """
    n = joint_position.size
    read = np.empty(2 * n + WIDTH)
    for k in range(n):
        read[k] = joint_position[k] + error[k]
        read[n + k] = joint_velocity[k] + error[n + k]
    body, off = read[2 * n :], error[2 * n :]
    for k in range(3):
        body[GYRO + k] = gyro[k] + gyro_bias + off[GYRO + k]
        body[FORCE + k] = accelerometer[k] + off[FORCE + k]
    for foot in range(2):
        for pad in range(4):
            k = PADS + 4 * foot + pad
            body[k] = max(gain[foot, pad] * foot_force[foot, pad] + off[k], 0.0)
    roll, pitch, drift = off[ATTITUDE], off[ATTITUDE + 1], off[ATTITUDE + 2]
    norm = sqrt(1.0 + 0.25 * (roll * roll + pitch * pitch))
    tilt = (1.0 / norm, 0.5 * roll / norm, 0.5 * pitch / norm, 0.0)
    true = (orientation[0], orientation[1], orientation[2], orientation[3])
    turn = (cos(0.5 * drift), 0.0, 0.0, sin(0.5 * drift))
    w, x, y, z = product(turn, product(true, tilt))
    body[ATTITUDE], body[ATTITUDE + 1], body[ATTITUDE + 2], body[ATTITUDE + 3] = w, x, y, z
    return read
