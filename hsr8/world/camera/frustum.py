"""Frustum culling: geoms outside the view of a camera.

MuJoCo renders every geom wherever the camera looks. Without a graphics card a vertex outside the
view costs as much as a visible one.
"""

from math import hypot, radians, tan

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.camera import frustum_kernel

Bools = NDArray[np.bool_]


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
        # The body that carries the camera is invisible: its faces are seen from inside.
        self._reach[model.geom_bodyid == model.cam_bodyid[self._camera]] = -np.inf
        # Bounding spheres of the long, thin boxes of the world are too loose.
        aligned = (np.abs(model.geom_quat[:, 0]) == 1.0) & (model.geom_bodyid == 0)
        self._boxes = np.flatnonzero(aligned & (model.geom_type == mujoco.mjtGeom.mjGEOM_BOX))
        self._halves = model.geom_size[self._boxes].copy()

    def outside(self, data: mujoco.MjData) -> Bools:
        """Return which geoms lie entirely outside, by bounding spheres or as boxes (ngeom,)."""
        return frustum_kernel.outside(
            data.geom_xpos,
            data.cam_xpos[self._camera],
            data.cam_xmat[self._camera],
            self._normals,
            self._reach,
            self._boxes,
            self._halves,
        )
