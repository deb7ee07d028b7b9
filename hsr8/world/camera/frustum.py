"""Frustum culling: geoms outside the view of a camera.

MuJoCo renders every geom wherever the camera looks. Without a graphics card a vertex outside the
view costs as much as a visible one.
"""

from math import hypot, radians, tan

import mujoco
import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Bools = NDArray[np.bool_]

Array = NDArray[np.float64]
Ints = NDArray[np.intp]


class Frustum:
    """View frustum of a camera of a model.

    Args:
        model: compiled world.
        camera: name of the camera.
        aspect: width of the image over its height [1].
    """

    def __init__(self, model: mujoco.MjModel, camera: str, aspect: float) -> None:
        self._camera = int(model.camera(camera).id)
        vertical = tan(0.5 * radians(float(model.cam_fovy[self._camera])))
        horizontal = aspect * vertical
        # Inward normals of the sides, and the axis; MuJoCo cameras look along -z.
        sides = [
            np.array([x, y, -slope]) / hypot(1.0, slope)
            for x, y, slope in (
                (-1.0, 0.0, horizontal),
                (1.0, 0.0, horizontal),
                (0.0, -1.0, vertical),
                (0.0, 1.0, vertical),
            )
        ]
        self._normals = np.array([*sides, [0.0, 0.0, -1.0]])
        # A plane has no bounding radius: it is never culled.
        self._reach = np.where(model.geom_rbound > 0.0, model.geom_rbound, np.inf)
        # The bodies that carry the camera are invisible: their faces are seen from inside.
        carrier = model.body_weldid[model.cam_bodyid[self._camera]]
        self._reach[model.body_weldid[model.geom_bodyid] == carrier] = -np.inf
        # Bounding spheres of the long, thin boxes of the world are too loose.
        aligned = (np.abs(model.geom_quat[:, 0]) == 1.0) & (model.geom_bodyid == 0)
        self._boxes = np.flatnonzero(aligned & (model.geom_type == mujoco.mjtGeom.mjGEOM_BOX))
        self._halves = model.geom_size[self._boxes].copy()

    def outside(self, data: mujoco.MjData) -> Bools:
        """Return which geoms lie entirely outside, by bounding spheres or as boxes (ngeom,)."""
        return culled(
            data.geom_xpos,
            data.cam_xpos[self._camera],
            data.cam_xmat[self._camera],
            self._normals,
            self._reach,
            self._boxes,
            self._halves,
        )


@compiled
def culled(
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
        rotation: rotation from the camera to W, row by row (9,).
        normals: normals of the sides in the camera frame, inward (m, 3).
        reach: bounding radius of each geom (n,) [m].
        boxes: geoms that are boxes along the axes of W (k,).
        halves: half sides of the boxes (k, 3) [m].
    """
    beyond = np.zeros(len(positions), np.bool_)
    for side in range(len(normals)):
        a, b, c = normals[side]
        x = rotation[0] * a + rotation[1] * b + rotation[2] * c
        y = rotation[3] * a + rotation[4] * b + rotation[5] * c
        z = rotation[6] * a + rotation[7] * b + rotation[8] * c
        apex = x * eye[0] + y * eye[1] + z * eye[2]
        for k in range(len(positions)):
            depth = x * positions[k, 0] + y * positions[k, 1] + z * positions[k, 2] - apex
            if depth < -reach[k]:
                beyond[k] = True
        for i in range(len(boxes)):
            k = boxes[i]
            depth = x * positions[k, 0] + y * positions[k, 1] + z * positions[k, 2] - apex
            if depth < -(abs(x) * halves[i, 0] + abs(y) * halves[i, 1] + abs(z) * halves[i, 2]):
                beyond[k] = True
    return beyond
