"""Compiled part of the local map: look-up of cells at points."""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Corner = tuple[int, int]


@compiled
def lookup(points: Array, corner: Corner, cell: float, cells: Array, outside: float) -> Array:
    """Return the values of a square grid at points (m,).

    Args:
        points: in W (m, 2) [m].
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
        points: in W (m, 2) [m].
        corner: index of the first column and row, counted from the origin of W.
        cell: side of a cell [m].
        log_odds: of occupancy, rows along y, columns along x (n, n).
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
