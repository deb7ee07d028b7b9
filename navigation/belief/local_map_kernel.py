"""Compiled part of the local map: what its cells hold under points."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Corner = tuple[int, int]


@njit(cache=True)
def under(points: Array, corner: Corner, cell: float, cells: Array, outside: float) -> Array:
    """What a square grid holds under points.

    Args:
        points: in W (m, 2) [m].
        corner: number of the first column and row from the origin of W.
        cell: side of a cell [m].
        cells: rows along y, columns along x (n, n).
        outside: what holds outside the grid.

    Returns:
        (m,).
    """
    n = len(cells)
    held = np.empty(len(points))
    for k in range(len(points)):
        # Numbers of cells stay floats until they are known to be inside: any may come.
        column = np.floor(points[k, 0] / cell) - corner[0]
        row = np.floor(points[k, 1] / cell) - corner[1]
        inside = 0.0 <= row < n and 0.0 <= column < n
        held[k] = cells[int(row), int(column)] if inside else outside
    return held


@njit(cache=True)
def free(points: Array, corner: Corner, cell: float, log_odds: Array) -> Mask:
    """Whether all the floor around points was seen empty: five cells in a cross (m,).

    Args:
        points: in W (m, 2) [m].
        corner: number of the first column and row from the origin of W.
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
