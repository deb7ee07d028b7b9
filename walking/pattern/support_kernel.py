"""Support region and polygon, compiled; see `walking.pattern.support`.

A region is a row: centre x, y [m] and direction (cosine, sine) of each sole; half of length and
width minus a margin [m] (10,). A polygon is a table of edges, counter-clockwise: start x, y,
vector x, y, length [m] (n, 5).
"""

from math import inf

from compilation import compiled
from walking.arrays import Array, Point


@compiled
def load_fraction(region: Array, x: float, y: float) -> float:
    """Return the load fraction of the second sole for a ZMP at x, y [m], in [0, 1]."""
    dx, dy = region[4] - region[0], region[5] - region[1]
    square = dx * dx + dy * dy
    if square == 0.0:
        return 0.0
    along = (x - region[0]) * dx + (y - region[1]) * dy
    return min(1.0, max(0.0, float(along / square)))


@compiled
def clip(region: Array, x: float, y: float) -> Point:
    """Clip a point to the region: to the rectangle at its load fraction [m]."""
    s = load_fraction(region, x, y)
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


@compiled
def depth(edges: Array, x: float, y: float) -> float:
    """Return the distance of a point from the edge of a polygon, negative outside [m]."""
    distance = inf
    for k in range(edges.shape[0]):
        edge = edges[k]
        distance = min(distance, (edge[2] * (y - edge[1]) - edge[3] * (x - edge[0])) / edge[4])
    return distance
