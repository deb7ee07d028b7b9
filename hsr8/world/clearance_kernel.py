"""The obstacle next to the robot, and how near its geoms may be to it, compiled."""

from math import hypot, inf

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.intp]


@njit(cache=True)
def nearest(
    places: Array,
    robot: Array,
    obstacles: Ints,
    radii: Array,
    geoms: Ints,
    spheres: Array,
    bounds: Array,
) -> tuple[float, int]:
    """Gap between the middle of the robot and the obstacle next to it [m], and its index.

    Args:
        places: of all geoms in W (ngeom, 3) [m].
        robot: where the robot is, x and y first [m].
        obstacles: geom of each obstacle (n,), at least one.
        radii: of the obstacles (n,) [m].
        geoms: of the robot (m,).
        spheres: radius of a sphere around each (m,) [m].
        bounds: set to what the gap between each of them and that obstacle is not less than,
            seen from above (m,) [m].
    """
    least, found = inf, 0
    for k in range(len(obstacles)):
        geom = obstacles[k]
        gap = hypot(places[geom, 0] - robot[0], places[geom, 1] - robot[1]) - radii[k]
        if gap < least:
            least, found = gap, k
    x, y = places[obstacles[found], 0], places[obstacles[found], 1]
    for k in range(len(geoms)):
        away = hypot(places[geoms[k], 0] - x, places[geoms[k], 1] - y)
        bounds[k] = away - spheres[k] - radii[found]
    return least, found
