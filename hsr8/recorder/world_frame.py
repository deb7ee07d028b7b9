"""From the odometry frame of the robot to the world frame."""

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.table import Table

Array = NDArray[np.float64]

LIGHT = 1.0  # feet that carry less have no centre of pressure [N]


class WorldFrame:
    """Transformation from the odometry frame to W by the true pose of the robot.

    Planned and true curves can be compared in W.

    Args:
        records: n rows of the table of records.

    Attributes:
        turn: rotation from the odometry frame to W at each row (n,) [rad].
    """

    def __init__(self, records: Table) -> None:
        x, y, yaw = records["odometry"].T
        true_x, true_y, true_yaw = records["robot"].T
        self.turn: Array = true_yaw - yaw
        self._c, self._s = np.cos(self.turn), np.sin(self.turn)
        self._x = true_x - self._c * x + self._s * y
        self._y = true_y - self._s * x - self._c * y

    def point(self, points: Array, rows: NDArray[np.intp] | slice = slice(None)) -> Array:
        """Transform points (n, ..., 2), one per row or of the given `rows` [m]."""
        x, y = points.T
        c, s = self._c[rows], self._s[rows]
        return np.array((self._x[rows] + c * x - s * y, self._y[rows] + s * x + c * y)).T

    def vector(self, vectors: Array) -> Array:
        """Rotate vectors (n, ..., 2)."""
        x, y = vectors.T
        return np.array([self._c * x - self._s * y, self._s * x + self._c * y]).T
