"""Local map: confidence and occupancy grid around the robot.

The confidence of a cell is 1 while it is in view and decays at xi_lm out of view (Yoo & Kim,
eq. (1)). It depends only on the time since the cell was last seen, which the map stores, so
it does not depend on the frame rate.
"""

from copy import copy
from math import floor

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compilation import compiled
from navigation.belief.visibility import (
    OCCUPIED,
    UNSEEN,
    Marks,
    Mask,
    Viewpoint,
    observed_cells,
)
from navigation.parameters.belief import LocalMapParameters

Array = NDArray[np.float64]
Corner = tuple[int, int]


class LocalMap:
    """Square grid of confidences C, eq. (1), aligned with W, that scrolls with the robot.

    Args:
        parameters: size, cell, rates.
        centre: initial centre in W [m].
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
    def cell(self) -> float:
        """Side of a cell [m]."""
        return self._parameters.cell

    @property
    def origin(self) -> tuple[float, float]:
        """Corner of minimum x and y in W [m]."""
        return self._corner[0] * self.cell, self._corner[1] * self.cell

    @property
    def age(self) -> Array:
        """Time since each cell was last seen (rows along y, columns along x) [s]."""
        age: Array = self._time - self._seen_at
        return age

    @property
    def confidence(self) -> Array:
        """Confidence C of each cell, eq. (1), shaped like `age` [1]."""
        return self._confidence_of(self.age)

    def confidence_at(self, points: ArrayLike) -> Array:
        """Return the confidence at points in W (n, 2); 1 outside the map (n,) [1]."""
        return self._confidence_of(self.age_at(points))

    def age_at(self, points: ArrayLike) -> Array:
        """Return the time since the cells at points in W (n, 2) were last seen (n,) [s].

        Infinite where never seen, 0 outside the map.
        """
        points = np.ascontiguousarray(points, np.float64)
        seen_at = lookup(points, self._corner, self.cell, self._seen_at, self._time)
        age: Array = self._time - seen_at
        return age

    def free_at(self, points: ArrayLike) -> Mask:
        """Return whether the floor around points in W (n, 2) was seen empty (n,)."""
        points = np.ascontiguousarray(points, np.float64)
        return free(points, self._corner, self.cell, self._log_odds)

    def update(
        self,
        time: float,
        viewpoint: Viewpoint,
        centre: tuple[float, float],
        obstacles: Array,
        radii: Array,
    ) -> None:
        """Update by one frame.

        Args:
            time: time of the frame [s].
            viewpoint: its camera in W.
            centre: position of the robot in W [m].
            obstacles: centres of the detected obstacles in W (n, 2) [m].
            radii: their radii (n,) [m].
        """
        p = self._parameters
        dt = min(time - self._time, p.max_look_time)
        self._time = time
        self._scroll(centre)
        corner = np.array(self._corner, float)
        marks = observed_cells(corner, p.cell, self._count, *viewpoint, obstacles, radii)
        evidence = (dt * p.free_rate, dt * p.occupied_rate, p.max_log_odds)
        update_grid(marks, self._seen_at, self._log_odds, time, evidence)

    def contents(self) -> tuple[Array, Array, Array]:
        """Return the whole state for comparison, read-only."""
        return np.array([*self._corner, self._time]), self._seen_at, self._log_odds

    def snapshot(self) -> "LocalMap":
        """Return a copy that later updates leave unchanged."""
        snapshot = copy(self)
        snapshot._seen_at = self._seen_at.copy()
        snapshot._log_odds = self._log_odds.copy()
        return snapshot

    def _confidence_of(self, age: Array) -> Array:
        confidence: Array = np.maximum(0.0, 1.0 + self._parameters.attenuation * age)
        return confidence

    def _corner_for(self, centre: tuple[float, float]) -> tuple[int, int]:
        half = self._count // 2
        return floor(centre[0] / self.cell) - half, floor(centre[1] / self.cell) - half

    def _scroll(self, centre: tuple[float, float]) -> None:
        """Shift the grid by whole cells so that the robot stays near its centre."""
        corner = self._corner_for(centre)
        columns, rows = corner[0] - self._corner[0], corner[1] - self._corner[1]
        if columns == 0 and rows == 0:
            return
        self._corner = corner
        self._seen_at = shifted(self._seen_at, rows, columns, -np.inf)
        self._log_odds = shifted(self._log_odds, rows, columns, 0.0)


@compiled
def shifted(cells: Array, rows: int, columns: int, empty: float) -> Array:
    """Return the cells (n, n) of a window moved by (rows, columns); new cells are `empty`."""
    n = len(cells)
    moved = np.full((n, n), empty)
    for row in range(max(0, -rows), n - max(0, rows)):
        for column in range(max(0, -columns), n - max(0, columns)):
            moved[row, column] = cells[row + rows, column + columns]
    return moved


@compiled
def lookup(points: Array, corner: Corner, cell: float, cells: Array, outside: float) -> Array:
    """Return the values of a square grid at points (m,).

    Args:
        points: points in W (m, 2) [m].
        corner: index of the first column and row, counted from the origin of W.
        cell: side of a cell [m].
        cells: rows along y, columns along x (n, n).
        outside: value outside the grid.
    """
    n = len(cells)
    values = np.empty(len(points))
    for k in range(len(points)):
        # Indices stay floats until they are known to be inside: points may be anywhere.
        column = np.floor(points[k, 0] / cell) - corner[0]
        row = np.floor(points[k, 1] / cell) - corner[1]
        inside = 0.0 <= row < n and 0.0 <= column < n
        values[k] = cells[int(row), int(column)] if inside else outside
    return values


@compiled
def free(points: Array, corner: Corner, cell: float, log_odds: Array) -> Mask:
    """Return whether the five cells in a cross around each point are free (m,).

    Args:
        points: points in W (m, 2) [m].
        corner: index of the first column and row, counted from the origin of W.
        cell: side of a cell [m].
        log_odds: log odds of occupancy, rows along y, columns along x (n, n).
    """
    n = len(log_odds)
    empty = np.zeros(len(points), np.bool_)
    for k in range(len(points)):
        column = np.floor(points[k, 0] / cell) - corner[0]
        row = np.floor(points[k, 1] / cell) - corner[1]
        if 0.0 < row < n - 1 and 0.0 < column < n - 1:
            i, j = int(row), int(column)
            highest = max(log_odds[i, j], log_odds[i - 1, j], log_odds[i + 1, j])
            empty[k] = max(highest, log_odds[i, j - 1], log_odds[i, j + 1]) < 0.0
    return empty


@compiled
def update_grid(
    marks: Marks, seen_at: Array, log_odds: Array, time: float, evidence: tuple[float, float, float]
) -> None:
    """Update a grid by one frame, in place.

    Args:
        marks: marks of the frame (n, n), see `observed_cells`.
        seen_at: time at which each cell was last seen (n, n) [s].
        log_odds: log odds of occupancy (n, n).
        time: time of the frame [s].
        evidence: change of the log odds of a free and of an occupied cell, and their maximum
            absolute value [1].
    """
    free, occupied, limit = evidence
    for row in range(len(marks)):
        for column in range(len(marks)):
            mark = marks[row, column]
            if mark != UNSEEN:
                seen_at[row, column] = time
                odds = log_odds[row, column] + (occupied if mark == OCCUPIED else free)
                log_odds[row, column] = min(max(odds, -limit), limit)
