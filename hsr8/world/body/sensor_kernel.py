"""Sensor noise on one reading of encoders, IMU and foot pads, compiled.

A row of errors and a reading both hold joint angles (n) [rad], joint rates (n) [rad/s], turn
rates (3) [rad/s], specific force (3) [m/s²] and foot forces (8) [N]. They end with roll, pitch
and heading drift [rad] for errors, and with the attitude quaternion w-x-y-z for a reading.
"""

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Quaternion = tuple[float, float, float, float]

GYRO, FORCE, PADS, ATTITUDE, WIDTH = 0, 3, 6, 14, 18  # columns after those of the joints


@compiled
def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the Hamilton product: first `b`, then `a`."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


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
    w, x, y, z = _product(turn, _product(true, tilt))
    body[ATTITUDE], body[ATTITUDE + 1], body[ATTITUDE + 2], body[ATTITUDE + 3] = w, x, y, z
    return read
