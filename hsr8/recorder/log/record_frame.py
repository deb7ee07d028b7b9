"""From the odometry frame of records to the world frame."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hsr8.record import TickRecord

Array = NDArray[np.float64]

LIGHT = 1.0  # feet that carry less have no centre of pressure [N]


class OdometryToWorld:
    """Transformation from the odometry frame to W by the true pose of the robot.

    Args:
        records: n records.

    Attributes:
        turn: rotation from the odometry frame to W at each record (n,) [rad].
    """

    def __init__(self, records: Sequence[TickRecord]) -> None:
        odometry = [record.walking.odometry for record in records]
        x, y, yaw = np.reshape([(here.x, here.y, here.yaw) for here in odometry], (-1, 3)).T
        true_x, true_y, true_yaw = np.reshape([r.truth.robot for r in records], (-1, 3)).T
        self.turn: Array = true_yaw - yaw
        self._c, self._s = np.cos(self.turn), np.sin(self.turn)
        self._x = true_x - self._c * x + self._s * y
        self._y = true_y - self._s * x - self._c * y

    def point(self, points: Array, rows: NDArray[np.intp] | slice = slice(None)) -> Array:
        """Transform points (n, ..., 2), one per record or of the records in `rows` [m]."""
        x, y = points.T
        c, s = self._c[rows], self._s[rows]
        return np.array((self._x[rows] + c * x - s * y, self._y[rows] + s * x + c * y)).T

    def vector(self, vectors: Array) -> Array:
        """Rotate vectors (n, ..., 2)."""
        x, y = vectors.T
        return np.array([self._c * x - self._s * y, self._s * x + self._c * y]).T
