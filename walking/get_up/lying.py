"""How the robot lies: the side of the trunk that is turned to the floor."""

from enum import StrEnum

from walking.parameters import CONTROL_PERIOD, GetUpParameters

Vector = tuple[float, float, float]


class Lying(StrEnum):
    """Side of the trunk on the floor."""

    FRONT = "front"
    BACK = "back"
    LEFT = "left"
    RIGHT = "right"


def up_in_trunk(quaternion: tuple[float, float, float, float]) -> Vector:
    """Upward vertical seen from the trunk: forward, left and headward component [1].

    Unlike roll and pitch it knows no attitude in which it breaks down; a lying trunk is pitched
    by a right angle.

    Args:
        quaternion: attitude of the trunk, w-x-y-z.
    """
    w, x, y, z = quaternion
    return 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)


def lying_on(up: Vector) -> Lying:
    """Side on which a trunk with the upward vertical `up` lies."""
    forward, left, _ = up
    if abs(forward) >= abs(left):
        return Lying.BACK if forward > 0.0 else Lying.FRONT
    return Lying.RIGHT if left > 0.0 else Lying.LEFT


class Rest:
    """Decides that the trunk has come to rest.

    Args:
        parameters: rate and duration.
    """

    def __init__(self, parameters: GetUpParameters) -> None:
        self._rate = parameters.rest_rate
        self._ticks = round(parameters.rest_time / CONTROL_PERIOD)
        self._count = 0

    def update(self, gyro: Vector) -> bool:
        """Whether it has turned slowly for long enough, with this tick's rate [rad/s]."""
        self._count = self._count + 1 if max(map(abs, gyro)) < self._rate else 0
        return self._count >= self._ticks
