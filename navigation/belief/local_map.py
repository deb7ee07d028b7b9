"""Local map: which places around the robot were seen, how long ago, and what is there.

The confidence of a cell is 1 while it is in view and then decays at xi_lm (Yoo & Kim,
eq. (1)). It is a function of the time since the cell was last seen, so the map stores
that time: no frame rate enters.
"""

from math import floor

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navigation.belief import local_map_kernel
from navigation.belief.visibility import Mask, Viewpoint
from navigation.belief.visibility_kernel import take_in
from navigation.parameters.belief import LocalMapParameters

Array = NDArray[np.float64]


class LocalMap:
    """Confidence C of eq. (1): a square grid fixed to W that rolls along with the robot.

    Args:
        parameters: size, cell, rates.
        centre: where the map is centred at first in W [m].
        time: [s].
    """

    def __init__(
        self, parameters: LocalMapParameters, centre: tuple[float, float], time: float
    ) -> None:
        self._parameters = parameters
        self._count = max(1, round(parameters.size / parameters.cell))
        self._time = time
        self._corner = self._corner_for(centre)
        self._seen_at = np.full((self._count, self._count), -np.inf)
        self._log_odds = np.zeros((self._count, self._count))

    @property
    def time(self) -> float:
        """Time of the last update [s]."""
        return self._time

    @property
    def cell(self) -> float:
        """Side of a cell [m]."""
        return self._parameters.cell

    @property
    def origin(self) -> tuple[float, float]:
        """Corner of least x and y in W [m]."""
        return self._corner[0] * self.cell, self._corner[1] * self.cell

    @property
    def age(self) -> Array:
        """Time since each cell was last seen (rows along y, columns along x) [s]."""
        age: Array = self._time - self._seen_at
        return age

    @property
    def confidence(self) -> Array:
        """Confidence C of each cell, shaped like `age` [1]."""
        return self._confidence_of(self.age)

    def confidence_at(self, points: ArrayLike) -> Array:
        """Confidence of the cells under points in W (n, 2); 1 outside the map (n,) [1]."""
        return self._confidence_of(self.age_at(points))

    def age_at(self, points: ArrayLike) -> Array:
        """Time since the cells under points in W (n, 2) were seen (n,) [s].

        Infinite where never seen, 0 outside the map.
        """
        places = np.ascontiguousarray(points, np.float64)
        seen_at = local_map_kernel.under(places, self._corner, self.cell, self._seen_at, self._time)
        age: Array = self._time - seen_at
        return age

    def free_at(self, points: ArrayLike) -> Mask:
        """Whether all the floor around points in W (n, 2) was once seen empty (n,)."""
        places = np.ascontiguousarray(points, np.float64)
        return local_map_kernel.free(places, self._corner, self.cell, self._log_odds)

    def update(
        self,
        time: float,
        viewpoint: Viewpoint,
        centre: tuple[float, float],
        obstacles: Array,
        radii: Array,
    ) -> None:
        """Take in what one frame showed.

        Args:
            time: of the frame [s].
            viewpoint: its camera in W.
            centre: position of the robot in W [m].
            obstacles: centres of the obstacles in the frame, in W (n, 2) [m].
            radii: their radii (n,) [m].
        """
        p = self._parameters
        dt = min(time - self._time, p.max_look_time)
        self._time = time
        self._roll(centre)
        marks = viewpoint.searched(self._corner, p.cell, self._count, obstacles, radii)
        evidence = (dt * p.free_rate, dt * p.occupied_rate, p.max_log_odds)
        take_in(marks, self._seen_at, self._log_odds, time, evidence)

    def contents(self) -> tuple[Array, Array, Array]:
        """All that the map holds, to compare it bit by bit; do not write into it."""
        return np.array([*self._corner, self._time]), self._seen_at, self._log_odds

    def snapshot(self) -> "LocalMap":
        """Copy that later updates of this map leave as it is."""
        copy = object.__new__(LocalMap)
        copy._parameters = self._parameters
        copy._count = self._count
        copy._time = self._time
        copy._corner = self._corner
        copy._seen_at = self._seen_at.copy()
        copy._log_odds = self._log_odds.copy()
        return copy

    def _confidence_of(self, age: Array) -> Array:
        confidence: Array = np.maximum(0.0, 1.0 + self._parameters.attenuation * age)
        return confidence

    def _corner_for(self, centre: tuple[float, float]) -> tuple[int, int]:
        half = self._count // 2
        return floor(centre[0] / self.cell) - half, floor(centre[1] / self.cell) - half

    def _roll(self, centre: tuple[float, float]) -> None:
        """Move the map by whole cells so that the robot stays near its middle."""
        corner = self._corner_for(centre)
        shift_x, shift_y = corner[0] - self._corner[0], corner[1] - self._corner[1]
        if shift_x == 0 and shift_y == 0:
            return
        self._corner = corner
        self._seen_at = _shifted(self._seen_at, shift_y, shift_x, -np.inf)
        self._log_odds = _shifted(self._log_odds, shift_y, shift_x, 0.0)


def _shifted(cells: Array, rows: int, columns: int, empty: float) -> Array:
    """Cells of a window moved by (rows, columns); what was outside is `empty`."""
    n, m = cells.shape
    moved = np.full((n, m), empty)
    if abs(rows) < n and abs(columns) < m:
        target = (
            slice(max(0, -rows), n - max(0, rows)),
            slice(max(0, -columns), m - max(0, columns)),
        )
        source = (
            slice(max(0, rows), n + min(0, rows)),
            slice(max(0, columns), m + min(0, columns)),
        )
        moved[target] = cells[source]
    return moved
