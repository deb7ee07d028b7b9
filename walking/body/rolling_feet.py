"""Feet that roll over heel, toe or edge while they carry the robot."""

import numpy as np

from walking.arrays import Array


class RollingFeet:
    """Contact points of both feet, and their motion relative to the base.

    The frame of a foot that rolls moves, although the foot does not slide. The point of the sole at
    the centre of pressure does not move.

    Attributes:
        contact: contact point of each foot relative to the base, level axes (2, 3) [m].
        motion: displacement of the points in contact since the last tick, relative to the base;
            axes of the IMU's yaw, z up (2, 3) [m].
        rolled: part of their displacement by rolling, since each foot landed; robot frame
            (2, 2) [m].
    """

    def __init__(self) -> None:
        self.contact = np.zeros((2, 3))
        self.motion = np.zeros((2, 3))
        self.rolled = np.zeros((2, 2))
        self._sum = np.zeros((2, 3))
        self._before: tuple[Array, Array] | None = None

    def update(
        self, position: Array, rotation: Array, pressure: Array, yaw: float, loaded: list[bool]
    ) -> None:
        """Run one tick.

        Args:
            position: of each foot relative to the base, level axes (2, 3) [m].
            rotation: of each foot, level axes (2, 3, 3).
            pressure: centre of pressure of each foot in its frame, x, y (2, 2) [m].
            yaw: of the IMU [rad].
            loaded: whether the left and the right foot are on the floor.
        """
        c, s = np.cos(yaw), np.sin(yaw)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        arms = np.column_stack([pressure, np.zeros(2)])
        self.contact = position + _turned(rotation, arms)
        turned, moved = turn @ rotation, position @ turn.T
        if self._before is not None:
            moved_before, turned_before = self._before
            rolling = _turned(turned - turned_before, arms)
            self.motion = moved - moved_before + rolling
            self._sum = np.where(np.array(loaded)[:, None], self._sum + rolling, 0.0)
            self.rolled = (self._sum @ turn)[:, :2]
        self._before = moved, turned


def _turned(rotations: Array, vectors: Array) -> Array:
    """Return the vectors (n, 3), each multiplied by its matrix (n, 3, 3)."""
    product: Array = np.einsum("kij,kj->ki", rotations, vectors)
    return product
