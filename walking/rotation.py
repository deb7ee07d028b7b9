"""Attitude from quaternions: the one place where walking meets them (order w-x-y-z)."""

from math import atan2, pi, sqrt


def roll_pitch_yaw(
    quaternion: tuple[float, float, float, float],
) -> tuple[float, float, float]:
    """Roll, pitch and heading of an attitude R = Rz(yaw) Ry(pitch) Rx(roll) [rad]."""
    w, x, y, z = quaternion
    sine = 2.0 * (w * y - x * z)
    cosine = sqrt(max(0.0, 1.0 - sine * sine))
    return (
        atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        atan2(sine, cosine),
        atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )


def wrap(angle: float) -> float:
    """The same angle in [-π, π) [rad]."""
    return (angle + pi) % (2.0 * pi) - pi
