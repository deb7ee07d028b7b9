"""Lying side and rest of a fallen robot."""

from enum import StrEnum

from walking.arrays import Vector
from walking.parameters import CONTROL_PERIOD, GetUpParameters


class Lying(StrEnum):
    """Side of the trunk on the floor."""

    FRONT = "front"
    BACK = "back"
    LEFT = "left"
    RIGHT = "right"


def up_in_trunk(quaternion: tuple[float, float, float, float]) -> Vector:
    """Return the vertical in the trunk frame: forward, left and headward component [1].

    Unlike roll and pitch it has no singularity at the pitch of a lying trunk, 90°.

    Args:
        quaternion: attitude of the trunk, w-x-y-z.
    """
    w, x, y, z = quaternion
    return 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)


def lying_on(up: Vector) -> Lying:
    """Return the lying side of a trunk with vertical `up`."""
    forward, left, _ = up
    if abs(forward) >= abs(left):
        return Lying.BACK if forward > 0.0 else Lying.FRONT
    return Lying.RIGHT if left > 0.0 else Lying.LEFT


class RestDetector:
    """Detects that the trunk is at rest.

    Args:
        parameters: maximum rate and its duration.
    """

    def __init__(self, parameters: GetUpParameters) -> None:
        self._rate = parameters.rest_rate
        self._ticks = round(parameters.rest_time / CONTROL_PERIOD)
        self._count = 0

    def update(self, gyro: Vector) -> bool:
        """Whether the trunk is at rest, given this tick's angular velocity [rad/s]."""
        self._count = self._count + 1 if max(map(abs, gyro)) < self._rate else 0
        return self._count >= self._ticks
