"""Frustum culling of spheres and boxes, compiled."""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.intp]


@compiled
def outside(
    positions: Array,
    eye: Array,
    rotation: Array,
    normals: Array,
    reach: Array,
    boxes: Ints,
    halves: Array,
) -> Bools:
    """Return which geoms lie entirely beyond one of the sides (n,).

    Args:
        positions: centre of each geom in W (n, 3) [m].
        eye: apex of the frustum in W (3,) [m].
        rotation: from the camera to W, row by row (9,).
        normals: of the sides in the camera frame, inward (m, 3).
        reach: bounding radius of each geom (n,) [m].
        boxes: geoms that are boxes along the axes of W (k,).
        halves: half sides of the boxes (k, 3) [m].
    """
    culled = np.zeros(len(positions), np.bool_)
    for side in range(len(normals)):
        a, b, c = normals[side]
        x = rotation[0] * a + rotation[1] * b + rotation[2] * c
        y = rotation[3] * a + rotation[4] * b + rotation[5] * c
        z = rotation[6] * a + rotation[7] * b + rotation[8] * c
        apex = x * eye[0] + y * eye[1] + z * eye[2]
        for k in range(len(positions)):
            depth = x * positions[k, 0] + y * positions[k, 1] + z * positions[k, 2] - apex
            if depth < -reach[k]:
                culled[k] = True
        for i in range(len(boxes)):
            k = boxes[i]
            depth = x * positions[k, 0] + y * positions[k, 1] + z * positions[k, 2] - apex
            if depth < -(abs(x) * halves[i, 0] + abs(y) * halves[i, 1] + abs(z) * halves[i, 2]):
                culled[k] = True
    return culled
