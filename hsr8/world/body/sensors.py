"""Sensor suite: noisy readings of encoders, IMU and foot pads."""

from math import cos, sin, sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.model.index import ModelIndex
from hsr8.world.rotation import product
from walking.state import BodySensors

Array = NDArray[np.float64]
Ints = NDArray[np.intp]

BLOCK = 200  # readings per draw of errors

GYRO, FORCE, PADS, ATTITUDE, WIDTH = 0, 3, 6, 14, 18  # columns after those of the joints


class SensorSuite:
    """Adds seeded noise to true readings; one instance per run.

    Args:
        noise: magnitudes.
        rng: generator of this subsystem.
        period: control tick [s].
        index: addresses in the model.
    """

    def __init__(
        self, noise: SensorNoise, rng: np.random.Generator, period: float, index: ModelIndex
    ) -> None:
        self._tilt_bias = noise.roll_bias, noise.pitch_bias
        self._gyro_bias = float(noise.gyro_bias)
        self._rng = rng
        self._bias_step = noise.gyro_bias * period
        self._yaw_drift = 0.0  # at the last drawn error
        self._gain = 1.0 + noise.foot_force_gain * rng.standard_normal((2, 4))
        joints = len(index.names)
        widths = (joints, joints, 3, 3, 8, 1, 1, 1)
        self._joints, self._body = joints, 2 * joints
        root = index.root_qpos
        self._addresses = np.concatenate(
            [
                index.joint_qpos,
                index.joint_dof,
                np.arange(index.root_dof + 3, index.root_dof + 6),
                index.accelerometer,
                index.foot_force.ravel(),
                np.arange(root + 3, root + 7),
            ]
        )
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

    def read(self, data: mujoco.MjData) -> BodySensors:
        """Return one noisy reading of the present state."""
        if self._next == len(self._errors):
            self._draw()
        error = self._errors[self._next]
        self._next += 1
        read = reading(
            data.qpos,
            data.qvel,
            data.sensordata,
            self._addresses,
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
    qpos: Array,
    qvel: Array,
    sensordata: Array,
    addresses: Ints,
    error: Array,
    gain: Array,
    gyro_bias: float,
) -> Array:
    """Return one noisy reading of the state (2 n + `WIDTH`,), in the columns of `addresses`.

    Args:
        qpos: generalised position, MuJoCo order (nq,).
        qvel: generalised velocity, MuJoCo order (nv,).
        sensordata: readings of MuJoCo's sensors.
        addresses: addresses of the angles in `qpos` (n,) and of the rates in `qvel` (n,), of the
            turn rates in `qvel` (3,), of specific force (3,) and pads (8,) in `sensordata`, and of
            the attitude, a quaternion w-x-y-z, in `qpos` (4,).
        error: errors to add (2 n + 17,).
        gain: factors on the foot forces (2, 4) [1].
        gyro_bias: constant error of the turn rates [rad/s].
    """
    n = (len(addresses) - WIDTH) // 2
    read = np.empty(2 * n + WIDTH)
    for k in range(n):
        read[k] = qpos[addresses[k]] + error[k]
        read[n + k] = qvel[addresses[n + k]] + error[n + k]
    body, off, source = read[2 * n :], error[2 * n :], addresses[2 * n :]
    for k in range(3):
        body[GYRO + k] = qvel[source[GYRO + k]] + gyro_bias + off[GYRO + k]
        body[FORCE + k] = sensordata[source[FORCE + k]] + off[FORCE + k]
    for foot in range(2):
        for pad in range(4):
            k = PADS + 4 * foot + pad
            body[k] = max(gain[foot, pad] * sensordata[source[k]] + off[k], 0.0)
    roll, pitch, drift = off[ATTITUDE], off[ATTITUDE + 1], off[ATTITUDE + 2]
    norm = sqrt(1.0 + 0.25 * (roll * roll + pitch * pitch))
    tilt = (1.0 / norm, 0.5 * roll / norm, 0.5 * pitch / norm, 0.0)
    q = source[ATTITUDE:]
    true = (qpos[q[0]], qpos[q[1]], qpos[q[2]], qpos[q[3]])
    turn = (cos(0.5 * drift), 0.0, 0.0, sin(0.5 * drift))
    w, x, y, z = product(turn, product(true, tilt))
    body[ATTITUDE], body[ATTITUDE + 1], body[ATTITUDE + 2], body[ATTITUDE + 3] = w, x, y, z
    return read
