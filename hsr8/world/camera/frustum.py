"""What a camera cannot show, found before it is drawn.

MuJoCo draws everything wherever the camera looks, and without a graphics card the corners
of what is out of sight cost as much as those of what is seen.
"""

from math import hypot, radians, tan

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.camera import frustum_kernel

Bools = NDArray[np.bool_]


class Frustum:
    """The pyramid of space that a camera of a model sees.

    Args:
        model: compiled world.
        camera: name of the camera.
        aspect: width of its image over the height [1].
    """

    def __init__(self, model: mujoco.MjModel, camera: str, aspect: float) -> None:
        self._camera = int(model.camera(camera).id)
        vertical = tan(0.5 * radians(float(model.cam_fovy[self._camera])))
        horizontal = aspect * vertical
        # Normals of its sides, inward, and its axis; MuJoCo's cameras look along -z.
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
        # A plane has no radius: it is everywhere.
        self._reach = np.where(model.geom_rbound > 0.0, model.geom_rbound, np.inf)
        # A camera looks out of the shapes of its own body, which are seen from outside only.
        self._reach[model.geom_bodyid == model.cam_bodyid[self._camera]] = -np.inf
        # Boxes of the world that are not turned are long and thin: spheres say little of them.
        straight = (np.abs(model.geom_quat[:, 0]) == 1.0) & (model.geom_bodyid == 0)
        self._boxes = np.flatnonzero(straight & (model.geom_type == mujoco.mjtGeom.mjGEOM_BOX))
        self._halves = model.geom_size[self._boxes].copy()

    def misses(self, data: mujoco.MjData) -> Bools:
        """Which geoms lie wholly outside, by spheres around them or as boxes (ngeom,)."""
        return frustum_kernel.misses(
            data.geom_xpos,
            data.cam_xpos[self._camera],
            data.cam_xmat[self._camera],
            self._normals,
            self._reach,
            self._boxes,
            self._halves,
        )
