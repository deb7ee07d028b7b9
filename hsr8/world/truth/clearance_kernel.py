"""How near each geom of the robot may be to each obstacle, compiled."""

from math import hypot

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.intp]


@njit(cache=True)
def least_gaps(places: Array, obstacles: Ints, radii: Array, geoms: Ints, spheres: Array) -> Array:
    """What the gaps between n obstacles and m geoms are not less than, seen from above (n, m) [m].

    Args:
        places: of all geoms in W (ngeom, 3) [m].
        obstacles: geom of each obstacle (n,).
        radii: of the obstacles (n,) [m].
        geoms: of the robot (m,).
        spheres: radius of a sphere around each (m,) [m].
    """
    bounds = np.empty((len(obstacles), len(geoms)))
    for i in range(len(obstacles)):
        x, y = places[obstacles[i], 0], places[obstacles[i], 1]
        for k in range(len(geoms)):
            away = hypot(places[geoms[k], 0] - x, places[geoms[k], 1] - y)
            bounds[i, k] = away - spheres[k] - radii[i]
    return bounds
