"""Compiled against plain Python bit for bit, and against formulas over whole arrays."""

import numpy as np
import pytest

from navigation.belief import local_map_kernel as kernel

CELL = 0.1
CORNER = (-7, 4)
SIDE = 12


@pytest.fixture
def grid():
    rng = np.random.default_rng(3)
    low = np.multiply(CORNER, CELL)
    points = rng.uniform(low - 3 * CELL, low + (SIDE + 3) * CELL, (400, 2))
    strange = np.array([[np.nan, 0.5], [np.inf, 0.5], [0.0, -1e300]])
    return np.concatenate([points, strange]), rng.uniform(-3.0, 1.0, (SIDE, SIDE))


def test_compiled_and_plain_agree(grid):
    points, cells = grid
    for function, arguments in ((kernel.lookup, (cells, 7.0)), (kernel.free, (cells,))):
        result = function(points, CORNER, CELL, *arguments)
        assert np.array_equal(result, function.py_func(points, CORNER, CELL, *arguments))


def test_lookup_returns_the_cell_that_contains_a_point(grid):
    points, cells = grid
    result = kernel.lookup(points, CORNER, CELL, cells, 7.0)
    padded = np.pad(cells, SIDE, constant_values=7.0)
    column, row = (np.floor(points[:-3] / CELL).astype(int) - CORNER + SIDE).T
    assert np.array_equal(result[:-3], padded[row, column])
    assert (result[-3:] == 7.0).all()
    assert 100 < (result != 7.0).sum() < 300
