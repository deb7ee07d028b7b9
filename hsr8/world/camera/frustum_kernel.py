"""Spheres and boxes that lie outside a pyramid of space, compiled."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.intp]


@njit(cache=True)
def misses(
    places: Array,
    eye: Array,
    rotation: Array,
    normals: Array,
    reach: Array,
    boxes: Ints,
    halves: Array,
) -> Bools:
    """Which things lie wholly beyond one of the sides (n,).

    Args:
        places: middle of each thing in W (n, 3) [m].
        eye: apex of the pyramid in W (3,) [m].
        rotation: from the camera to W, row by row (9,).
        normals: of the sides in the camera, inward (m, 3).
        reach: radius of a sphere around each thing (n,) [m].
        boxes: things that are boxes along the axes of W (k,).
        halves: half their sides (k, 3) [m].
    """
    missed = np.zeros(len(places), np.bool_)
    for side in range(len(normals)):
        a, b, c = normals[side]
        x = rotation[0] * a + rotation[1] * b + rotation[2] * c
        y = rotation[3] * a + rotation[4] * b + rotation[5] * c
        z = rotation[6] * a + rotation[7] * b + rotation[8] * c
        apex = x * eye[0] + y * eye[1] + z * eye[2]
        for k in range(len(places)):
            depth = x * places[k, 0] + y * places[k, 1] + z * places[k, 2] - apex
            if depth < -reach[k]:
                missed[k] = True
        for i in range(len(boxes)):
            k = boxes[i]
            depth = x * places[k, 0] + y * places[k, 1] + z * places[k, 2] - apex
            if depth < -(abs(x) * halves[i, 0] + abs(y) * halves[i, 1] + abs(z) * halves[i, 2]):
                missed[k] = True
    return missed
