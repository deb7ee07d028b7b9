"""Where the floor can push, compiled; see `walking.pattern.support`.

A region is a row: centre x, y [m] and direction (cosine, sine) of one sole; the same of the other;
half of the length and of the width of either, a margin taken off [m] (10,). A polygon is given by
its edges, counter-clockwise: where each begins, x, y; its way x, y; its length [m] (n, 5).
"""

from math import inf

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]


@njit(cache=True)
def share(region: Array, x: float, y: float) -> float:
    """Load share of the second sole under a ZMP at x, y [m], in [0, 1]."""
    dx, dy = region[4] - region[0], region[5] - region[1]
    square = dx * dx + dy * dy
    if square == 0.0:
        return 0.0
    along = (x - region[0]) * dx + (y - region[1]) * dy
    return min(1.0, max(0.0, float(along / square)))


@njit(cache=True)
def clip(region: Array, x: float, y: float) -> Point:
    """A point of a region near x, y: in the rectangle at its load share [m]."""
    s = share(region, x, y)
    r = 1.0 - s
    cx, cy = r * region[0] + s * region[4], r * region[1] + s * region[5]
    c, n = r * region[2] + s * region[6], r * region[3] + s * region[7]
    scale = c * c + n * n
    dx, dy = x - cx, y - cy
    u = (c * dx + n * dy) / scale
    v = (c * dy - n * dx) / scale
    length, width = region[8], region[9]
    if -length <= u <= length and -width <= v <= width:
        return x, y
    u = min(length, max(-length, u))
    v = min(width, max(-width, v))
    return cx + c * u - n * v, cy + n * u + c * v


@njit(cache=True)
def depth(edges: Array, x: float, y: float) -> float:
    """How far inside a polygon a point lies; negative outside [m]."""
    least = inf
    for k in range(edges.shape[0]):
        edge = edges[k]
        least = min(least, (edge[2] * (y - edge[1]) - edge[3] * (x - edge[0])) / edge[4])
    return least
