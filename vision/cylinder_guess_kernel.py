"""Compiled part of the pose estimation of cylinders: the initial cylinder of a candidate."""

from math import asin, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Table = NDArray[np.int64]

MIN_HALF, MAX_HALF = 1e-3, 1.2  # bounds of the initial half width [rad]
FAR_SLOPE = -0.5  # slope of the foot above which a cylinder is far
MIN_SLOPE = 1e-6
SPAN_SIGMA = 0.02  # minimum relative standard deviation of a distance from a span [1]


@compiled
def _rim_distance(
    rims: Array, points: Table, slope: Array, h: float, radius: float, limits: Array
) -> float:
    """Return the distance measured by the rims, 0 if none does; see `guess` [m]."""
    clearance, min_distance, max_distance = limits[0], limits[1], limits[2]
    lowest = highest = -1
    for j in range(len(rims)):
        if points[j] < points[j + 1] and abs(rims[j, 0] - h) >= clearance:
            lowest = j if lowest < 0 else lowest
            highest = j
    if lowest < 0:
        return 0.0
    low = slope[(points[lowest] + points[lowest + 1]) // 2]
    high = slope[(points[highest] + points[highest + 1]) // 2]
    if low > FAR_SLOPE and high > low:
        # Far away the difference of the slopes is more robust against a tilt error.
        return float(min((rims[highest, 0] - rims[lowest, 0]) / (high - low), max_distance))
    for j in range(lowest, highest + 1):
        if points[j] == points[j + 1] or abs(rims[j, 0] - h) < clearance:
            continue
        middle = slope[(points[j] + points[j + 1]) // 2]
        run = (rims[j, 0] - h) / (middle if middle != 0.0 else MIN_SLOPE)
        if min_distance < run < max_distance:
            return float(run + rims[j, 1] * radius)
    return 0.0


@compiled
def _span(sides: Array, height: float, h: float) -> tuple[float, float]:
    """Return the distance to the only trusted side and its standard deviation, 0, 0 if none [m].

    The visible span of the side lies between foot and head. Of a close cylinder at the border
    of the image often neither is visible.
    """
    if (sides[0, 5] != 0.0) == (sides[1, 5] != 0.0):
        return 0.0, 0.0
    low, high = sides[0, 3], sides[0, 4]
    if sides[1, 5] != 0.0:
        low, high = sides[1, 3], sides[1, 4]
    if h <= height or high >= -MIN_SLOPE or low >= high:
        return 0.0, 0.0
    farthest, nearest = -h / low, (height - h) / high
    middle = 0.5 * (farthest + nearest)
    own, width = SPAN_SIGMA * middle, farthest - nearest
    return middle, sqrt(own * own + width * width / 12.0)


@compiled
def _cylinder(x: Array, sides: Array, radius: float, distance: float, min_distance: float) -> None:
    """Write azimuth, distance and radius x (3,); `distance` 0 if unknown [m]."""
    typical, left, right = radius, sides[0, 0], sides[1, 0]
    left_trusted, right_trusted = sides[0, 5] != 0.0, sides[1, 5] != 0.0
    half = min(max(0.5 * (left - right), MIN_HALF), MAX_HALF)
    if distance == 0.0:
        distance = radius / sin(half)
    if left_trusted and right_trusted:
        radius = min(max(distance * sin(half), 0.7 * typical), 1.5 * typical)
    distance = max(distance, min_distance + radius)
    azimuth = 0.5 * (left + right)
    if left_trusted != right_trusted:
        reach = asin(min(radius / distance, 0.9))
        azimuth = left - reach if left_trusted else right + reach
    x[0], x[1], x[2] = azimuth, distance, radius


@compiled
def guess(
    sides: Array,
    known: Array,
    rims: Array,
    first_rims: Table,
    points: Table,
    slope: Array,
    h: float,
    limits: Array,
) -> tuple[Array, Array]:
    """Return a first cylinder for each candidate; arguments as for `cylinder_kernel.locate`.

    Returns:
        Azimuth [rad], distance [m] and radius [m] (n, 3); distance to the only trusted side and
        its standard deviation, 0 if unknown (n, 2) [m].
    """
    n = len(sides)
    cylinders, spans = np.empty((n, 3)), np.empty((n, 2))
    for k in range(n):
        first, last = first_rims[k], first_rims[k + 1]
        ends, radius = points[first : last + 1], known[k, 0]
        distance = _rim_distance(rims[first:last], ends, slope, h, radius, limits)
        spans[k, 0], spans[k, 1] = _span(sides[k], known[k, 2], h)
        distance = spans[k, 0] if distance == 0.0 else distance
        _cylinder(cylinders[k], sides[k], radius, distance, limits[1])
    return cylinders, spans
