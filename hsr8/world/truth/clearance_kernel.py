"""Lower bounds of the gaps between the robot and the obstacles, compiled."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Ints = NDArray[np.intp]


@compiled
def gap_bounds(
    positions: Array, obstacles: Ints, radii: Array, geoms: Ints, spheres: Array
) -> Array:
    """Return lower bounds of the gaps between n obstacles and m geoms, from above (n, m) [m].

    Args:
        positions: of all geoms in W (ngeom, 3) [m].
        obstacles: geom of each obstacle (n,).
        radii: of the obstacles (n,) [m].
        geoms: of the robot (m,).
        spheres: bounding radius of each geom of the robot (m,) [m].
    """
    bounds = np.empty((len(obstacles), len(geoms)))
    for i in range(len(obstacles)):
        x, y = positions[obstacles[i], 0], positions[obstacles[i], 1]
        for k in range(len(geoms)):
            dx, dy = positions[geoms[k], 0] - x, positions[geoms[k], 1] - y
            distance = sqrt(dx * dx + dy * dy)
            bounds[i, k] = distance - spheres[k] - radii[i]
    return bounds
